#pragma once

#include <array>
#include <cstdint>
#include <set>
#include <utility>
#include <vector>

#include "tolerance/forced_edges.h"

namespace collarmesh {

/// The places of a mesh where the input leaves no room for tets with a bounded radius-edge ratio: between
/// features that have no point in common, between two sides of a patch, and between features that meet in a
/// crease, if their distance is below a share of the longest edge there.
class NarrowPlaces {
 public:
  /// Keeps a reference to the complex. `forced` must be made from this mesh. Features that meet at an angle
  /// below `crease_angle` (degrees) form a crease. `share`: the largest distance in narrow places, relative
  /// to the longest edge.
  NarrowPlaces(const Plc& plc, std::vector<TetMesh::VertexFeature> features, ForcedEdges forced,
               double crease_angle, double share);

  bool contain(const std::array<Point, 4>& p, const std::array<Index, 4>& corners) const;

 private:
  using Feature = std::pair<std::uint8_t, Index>;  // dimension and index of a feature

  bool across(Index a, Index b) const;
  std::vector<Feature> all_that_contain(const TetMesh::VertexFeature& feature) const;

  const Plc& plc_;
  std::vector<TetMesh::VertexFeature> features_;  // by vertex
  ForcedEdges forced_;
  std::set<std::pair<Feature, Feature>> in_creases_;  // pairs of features that meet in a crease, in both
                                                      // orders
  double share_;
};

}  // namespace collarmesh
