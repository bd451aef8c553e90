#pragma once

#include <span>
#include <vector>

#include "collarmesh/tet_mesh.h"

namespace collarmesh::periodicity {

/// A place of a node, and the length that its distance to other nodes should have.
struct SpacedPlace {
  Point place;
  double spacing;
};

/// Chooses nodes inside a planar patch of a refined mesh that are about as near to each other as the sizes
/// ask for. A refinement for quality may leave far more, which would stay if they were all fixed. Near the
/// patch's borders, and within half of the distance from them, nodes may be as near to each other as those on
/// the border. `targets`: target edge length at every vertex. Cost: n log n in the faces.
std::vector<SpacedPlace> sparse_nodes(const TetMesh& mesh, std::span<const Index> faces,
                                      const std::vector<double>& targets);

}  // namespace collarmesh::periodicity
