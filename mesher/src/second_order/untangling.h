#pragma once

#include <array>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "collarmesh/plc.h"
#include "collarmesh/tet_mesh.h"
#include "common/cells_at_vertices.h"
#include "second_order/mid_nodes.h"

namespace collarmesh::second_order {

/// The procedure that makes curved tets valid by moving nodes that lie on no smooth feature: nodes inside
/// regions anywhere, nodes on planar patches in their planes. They follow the curved edges beside them as far
/// as necessary. Divides the Jacobian's coefficients by that of the straight tet, and minimizes the sum of
/// the squares of their differences from 1 and of a logarithm that is infinite at a barrier. The barrier is
/// just below the least coefficient and rises until this coefficient is high enough (Toulorge, Geuzaine,
/// Remacle and Lambrechts, Robust untangling of curvilinear meshes, 2013).
class Untangling {
 public:
  /// Keeps all by reference.
  Untangling(TetMesh& mesh, const MeshEdges& edges, const Plc& plc, double least_jacobian);

  /// Makes a tet valid without making another one invalid. Returns the number of moved nodes; 0 if that was
  /// not possible, and then all nodes are at their old places. Precondition: the mesh has its nodes.
  std::size_t untangle(Index tet) { return untangle_within(tet, false); }
  /// Makes a tet valid by moving nodes in a wider neighbourhood, at several times the cost. Gives up after
  /// many failures.
  std::size_t untangle_farther(Index tet);
  /// Returns whether the node of this edge is inside a region or on a planar patch.
  bool is_free(Index edge) const;
  /// Returns whether the node of this edge may move.
  bool may_move(Index edge) const { return is_free(edge) && !kept_.contains(edge); }
  /// Fixes the node of this edge.
  void keep(Index edge) { kept_.insert(edge); }
  std::vector<Index> tets_at(Index edge);

 private:
  /// A node that may move: in the plane with this normal, or anywhere if the normal is zero.
  struct Free {
    Index node;
    Vector normal;
  };

  std::size_t untangle_within(Index tet, bool wide);
  void gather(Index tet, bool wide);
  double objective(double barrier, std::vector<Vector>* gradient) const;
  double least_coefficient() const;
  void minimize(double barrier);
  bool is_valid(Index tet) const;

  TetMesh& mesh_;
  const MeshEdges& edges_;
  const Plc& plc_;
  double least_jacobian_;
  CellsAtVertices tets_at_vertex_;  // empty until first used
  std::unordered_set<Index> kept_;  // edges of fixed nodes
  std::size_t wide_failures_ = 0;

  // State of the current tet:
  std::vector<Free> free_;
  std::unordered_map<Index, Index> free_at_;        // index in free_, by node
  std::vector<Index> tets_;                         // all tets that have a free node
  std::vector<std::array<Index, 6>> free_of_tets_;  // by tet: indices of its nodes in free_; none for fixed
                                                    // nodes
  std::vector<double> six_volumes_;                 // by tet: six times its volume with straight edges
};

}  // namespace collarmesh::second_order
