#include "tolerance/narrow_places.h"

#include <algorithm>

#include "collarmesh/plc_builder.h"

namespace collarmesh {

namespace {

// Returns the dimensions of the two features of a crease.
std::pair<std::uint8_t, std::uint8_t> dimensions_of(Crease::Kind kind) {
  switch (kind) {
    case Crease::Kind::segments: return {1, 1};
    case Crease::Kind::segment_and_facet: return {1, 2};
    default: return {2, 2};
  }
}

}  // namespace

NarrowPlaces::NarrowPlaces(const Plc& plc, std::vector<TetMesh::VertexFeature> features, ForcedEdges forced,
                           double crease_angle, double share)
    : plc_(plc), features_(std::move(features)), forced_(std::move(forced)), share_(share) {
  for (const Crease& crease : find_creases(plc, crease_angle)) {
    const auto [first, second] = dimensions_of(crease.kind);
    const Feature a{first, crease.features[0]}, b{second, crease.features[1]};
    if (a == b) continue;  // the crease is a fold: sides of one patch face each other
    in_creases_.emplace(a, b);
    in_creases_.emplace(b, a);
  }
}

bool NarrowPlaces::contain(const std::array<Point, 4>& p, const std::array<Index, 4>& corners) const {
  return narrowness_of(p, [&](unsigned i, unsigned j) { return across(corners[i], corners[j]); }) < share_;
}

// Returns whether an edge leads across a narrow place. False for vertices inserted later, which lie on no
// feature.
bool NarrowPlaces::across(Index a, Index b) const {
  if (forced_.forces(a, b)) return true;
  if (in_creases_.empty() || std::max(a, b) >= features_.size()) return false;
  const std::vector<Feature> of_a = all_that_contain(features_[a]), of_b = all_that_contain(features_[b]);
  const auto contains_both = [&](const Feature& f) { return std::ranges::find(of_b, f) != of_b.end(); };
  if (std::ranges::any_of(of_a, contains_both)) return false;
  return std::ranges::any_of(of_a, [&](const Feature& f) {
    return std::ranges::any_of(of_b, [&](const Feature& g) { return in_creases_.contains({f, g}); });
  });
}

std::vector<NarrowPlaces::Feature> NarrowPlaces::all_that_contain(
    const TetMesh::VertexFeature& feature) const {
  const auto& [dimension, index] = feature;
  if (dimension > 2 || index == none) return {};
  std::vector<Feature> found{{dimension, index}};
  const auto add = [&found](std::uint8_t of, const std::vector<Index>& features) {
    for (const Index f : features) found.emplace_back(of, f);
  };
  if (dimension == 0) {
    add(1, plc_.vertices[index].curves);
    add(2, plc_.vertices[index].patches);
  } else if (dimension == 1) {
    add(2, plc_.curves[index].patches);
  }
  return found;
}

}  // namespace collarmesh
