#pragma once

#include <span>
#include <vector>

#include "collarmesh/tet_mesh.h"

namespace collarmesh::periodicity {

/// The place of a node, and the distance that other nodes should have from it.
struct SpacedPlace {
  Point place;
  double spacing;
};

/// Chooses nodes inside a planar patch of a refined mesh, so that their distances are at least a small share
/// of the target edge length. Refinement may leave nodes far nearer to each other, and they would stay so if
/// all were fixed. On the patch's borders, lengths are at most those of the border's edges; away from the
/// borders, this limit grows by half of the distance. `targets`: target edge length at every vertex. Cost: n
/// log n in the faces, times the number of nodes that one node covers.
std::vector<SpacedPlace> sparse_nodes(const TetMesh& mesh, std::span<const Index> faces,
                                      const std::vector<double>& targets);

}  // namespace collarmesh::periodicity
