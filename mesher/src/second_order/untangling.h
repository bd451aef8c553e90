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

/// Makes curved tets valid by moving nodes that lie on no smooth feature: those inside regions anywhere,
/// those on planar patches in their planes. They follow the curved edges beside them, as far as it takes. The
/// sum of squares of a barrier and of what the Jacobian's coefficients differ from those of the straight tet
/// is lowered, the barrier just below the least of them, until that is high enough (Toulorge, Geuzaine,
/// Remacle and Lambrechts, Robust untangling of curvilinear meshes, 2013).
class Untangling {
 public:
  /// All are kept by reference. The mesh has its nodes already.
  Untangling(TetMesh& mesh, const MeshEdges& edges, const Plc& plc, double least_jacobian);

  /// Make a tet valid, and none invalid. How many nodes were moved for that; 0: that was not possible, and
  /// all are where they were.
  std::size_t untangle(Index tet) { return untangle_within(tet, false); }
  /// The same with more nodes around, at some times the cost; not after many times in vain.
  std::size_t untangle_farther(Index tet);
  /// Is the node of this edge inside a region or on a planar patch?
  bool is_free(Index edge) const;
  /// May it be moved?
  bool may_move(Index edge) const { return is_free(edge) && !kept_.contains(edge); }
  /// It may not, from here on.
  void keep(Index edge) { kept_.insert(edge); }
  std::vector<Index> tets_at(Index edge);

 private:
  /// A node that may move, in the plane with this normal, or anywhere if that is zero.
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
  CellsAtVertices tets_at_vertex_;  // empty until it is needed
  std::unordered_set<Index> kept_;  // edges
  std::size_t wide_failures_ = 0;

  // Of the tet at hand:
  std::vector<Free> free_;
  std::unordered_map<Index, Index> free_at_;        // in free_, by node
  std::vector<Index> tets_;                         // all that have a free node
  std::vector<std::array<Index, 6>> free_of_tets_;  // in free_, by their nodes; none for those that stay
  std::vector<double> six_volumes_;                 // of these, straight
};

}  // namespace collarmesh::second_order
