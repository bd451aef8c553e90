#include "refine/sizing.h"

#include <algorithm>

namespace collarmesh {

namespace {

constexpr double default_sizes_per_diagonal = 20;

double size_of_tag(const std::map<Tag, double>& sizes, Tag tag) {
  const auto found = sizes.find(tag);
  return found == sizes.end() ? INFINITY : found->second;
}

}  // namespace

Sizing::Sizing(const Plc& plc, const MeshOptions& options, const Frame& frame)
    : field_(options.size_field), frame_(frame), size_min_(options.size_min) {
  const double global =
      options.size > 0 ? options.size : plc.bounds.diagonal() / default_sizes_per_diagonal;
  global_size_ = global;
  for (const Plc::Region& region : plc.regions) {
    double size = std::min(global, size_of_tag(options.region_size, region.tag));
    if (region.size > 0) size = std::min(size, region.size);
    region_size_.push_back(std::max(size, size_min_));
    expected_cells_ += region.volume / (0.09 * region_size_.back() * region_size_.back() * region_size_.back());
  }
  for (const Plc::Patch& patch : plc.patches) {
    const double behind = patch.regions[0] > 0 ? region_size_[patch.regions[0]] : global;
    const double front = patch.regions[1] > 0 ? region_size_[patch.regions[1]] : global;
    const double size =
        std::min({behind, front, size_of_tag(options.patch_size, patch.tag)});
    patch_size_.push_back(std::max(size, size_min_));
  }
  for (const Plc::Curve& curve : plc.curves) {
    double size = std::min(global, size_of_tag(options.curve_size, curve.tag));
    for (const Index patch : curve.patches) size = std::min(size, patch_size_[patch]);
    curve_size_.push_back(std::max(size, size_min_));
  }
}

}  // namespace collarmesh
