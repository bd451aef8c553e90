#pragma once

#include <petscdmplex.h>

#include <array>
#include <vector>

#include "collarmesh/curved_tet.h"
#include "collarmesh/geometry.h"
#include "local_mesh.h"

namespace collarmesh::distributed {

/// The ends of a tet's edges, in the order of its mid-edge nodes (TetMesh::tet_mid_nodes).
inline constexpr std::array<std::array<std::size_t, 2>, 6> tet_edges{
    {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}};

/// The edges of a rank, numbered from 0, and their mid-edge nodes.
class Edges {
 public:
  explicit Edges(DM dm);

  std::size_t size() const { return ends_.size(); }
  const std::array<Index, 2>& ends(std::size_t edge) const { return ends_[edge]; }
  /// Return the edges of a tet and of a face (ab, bc, ca), given their numbers in the DMPlex and their
  /// corners.
  std::array<Index, 6> of_tet(PetscInt tet, const std::array<Index, 4>& corners) const;
  std::array<Index, 3> of_face(PetscInt face, const std::array<Index, 3>& corners) const;

  /// Returns the nodes that the coordinates of the DMPlex contain. Precondition: these are of order 2.
  std::vector<Point> nodes() const;
  void set_nodes(const std::vector<Point>& nodes);

 private:
  Index edge_of(const PetscInt* edges, std::size_t count, Index a, Index b) const;

  DM dm_;
  PetscInt first_ = 0;
  std::vector<std::array<Index, 2>> ends_;
};

inline CurvedTet curved(const Corners& corners, const std::array<Index, 6>& edges,
                        const std::vector<Point>& nodes) {
  CurvedTet tet;
  for (std::size_t k = 0; k < 4; ++k) tet[k] = corners[k];
  for (std::size_t k = 0; k < 6; ++k) tet[4 + k] = nodes[edges[k]];
  return tet;
}

}  // namespace collarmesh::distributed
