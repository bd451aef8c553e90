#include "check/touched_features.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "common/group_names.h"

namespace collarmesh::checks {

namespace {

constexpr std::size_t named_per_kind = 4;
constexpr std::array<std::string_view, 4> kind_names{"vertex", "curve", "patch", "region"};

/// The features of one dimension that a tet touches, each with the number of the tet's corners on it.
class Touched {
 public:
  void add(Index feature) {
    const auto found = std::find_if(counts_.begin(), counts_.end(),
                                    [&](const auto& count) { return count.first == feature; });
    if (found == counts_.end())
      counts_.emplace_back(feature, 1);
    else
      ++found->second;
  }
  void add(const std::vector<Index>& features) {
    for (const Index feature : features) add(feature);
  }
  std::vector<Index> most_touched_first() {
    std::sort(counts_.begin(), counts_.end(), [](const auto& a, const auto& b) {
      return a.second != b.second ? a.second > b.second : a.first < b.first;
    });
    std::vector<Index> features;
    for (const auto& [feature, count] : counts_) features.push_back(feature);
    return features;
  }

 private:
  std::vector<std::pair<Index, unsigned>> counts_;
};

Tag tag_of(const Plc& plc, std::size_t dimension, Index feature) {
  switch (dimension) {
    case 0: return plc.vertices[feature].tag;
    case 1: return plc.curves[feature].tag;
    case 2: return plc.patches[feature].tag;
    default: return plc.regions[feature].tag;
  }
}

std::string label(const MeshToCheck& to_check, std::size_t dimension, Index feature) {
  const Tag tag = tag_of(to_check.plc, dimension, feature);
  const std::string* given = to_check.plc.names.find(dimension, tag);
  const std::string name = given != nullptr ? *given : group_name(to_check.mesh, dimension, tag);
  const bool says_more = name != group_name(GroupNames::complex, dimension, tag);
  return fmt::format("{} {} (tag {}{}{})", kind_names[dimension], feature, tag, says_more ? ", " : "",
                     says_more ? name : "");
}

}  // namespace

TouchedFeatures::TouchedFeatures(const MeshToCheck& to_check)
    : to_check_(to_check), features_(features_of(to_check)) {}

std::string TouchedFeatures::of(Index tet) const {
  const Plc& plc = to_check_.plc;
  std::array<Touched, 3> touched;
  for (const Index corner : to_check_.mesh.tets[tet]) {
    const auto [dimension, feature] = features_[corner];
    if (dimension > 2) continue;
    touched[dimension].add(feature);
    if (dimension == 0) touched[1].add(plc.vertices[feature].curves);
    if (dimension == 0) touched[2].add(plc.vertices[feature].patches);
    if (dimension == 1) touched[2].add(plc.curves[feature].patches);
  }
  std::string names;
  for (std::size_t dimension = 0; dimension < touched.size(); ++dimension) {
    const std::vector<Index> features = touched[dimension].most_touched_first();
    for (std::size_t i = 0; i < std::min(named_per_kind, features.size()); ++i)
      names += fmt::format("{}{}", names.empty() ? "" : ", ", label(to_check_, dimension, features[i]));
    if (features.size() > named_per_kind) names += ", ...";
  }
  return fmt::format("in {} and touching {}", label(to_check_, 3, to_check_.mesh.tet_region[tet]),
                     names.empty() ? "no feature" : names);
}

}  // namespace collarmesh::checks
