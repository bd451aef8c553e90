#include "tolerance/feature_contacts.h"

#include <algorithm>
#include <utility>

#include "common/sort_uniquely.h"
#include "tolerance/facing.h"

namespace collarmesh {

namespace {

// If a vertex has more patches than this, they are not listed as neighbours of each other.
constexpr std::size_t patches_at_hub = 64;

}  // namespace

FeatureContacts::FeatureContacts(const Plc& plc)
    : plc_(plc), neighbours_(plc.patches.size()), at_hub_(plc.patches.size()) {
  const auto note = [&](const std::vector<Index>& patches) {
    for (const Index a : patches)
      if (patches.size() > patches_at_hub)
        at_hub_[a] = true;
      else
        neighbours_[a].insert(neighbours_[a].end(), patches.begin(), patches.end());
  };
  for (const Plc::Curve& curve : plc.curves) note(curve.patches);
  for (const Plc::Vertex& vertex : plc.vertices) note(vertex.patches);
  for (std::vector<Index>& patches : neighbours_) sort_uniquely(patches);
}

bool FeatureContacts::touch(unsigned dimension, Index feature, unsigned other_dimension, Index other) const {
  if (dimension > other_dimension) {
    std::swap(dimension, other_dimension);
    std::swap(feature, other);
  }
  if (dimension == other_dimension && feature == other) return true;
  if (dimension == 2) return patches_touch(feature, other);
  if (dimension == 0) {
    if (other_dimension == 0) return false;
    return other_dimension == 1 ? plc_.vertex_on_curve(feature, other) : plc_.vertex_on_patch(feature, other);
  }
  if (other_dimension == 2 && plc_.curve_on_patch(feature, other)) return true;
  const auto& ends = plc_.curves[feature].ends;
  return std::ranges::any_of(ends, [&](Index end) {
    if (end == none) return false;
    if (other_dimension == 2) return plc_.vertex_on_patch(end, other);
    const auto& others = plc_.curves[other].ends;
    return end == others[0] || end == others[1];
  });
}

bool FeatureContacts::patches_touch(Index a, Index b) const {
  return std::ranges::binary_search(neighbours_[a], b) ||
         (at_hub_[a] && at_hub_[b] && are_neighbours(plc_, a, b));
}

}  // namespace collarmesh
