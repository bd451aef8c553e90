#include "refine/sizing.h"

#include <fmt/format.h>

#include <algorithm>

#include "collarmesh/error.h"
#include "common/round_curves.h"

namespace collarmesh {

namespace {

constexpr double default_sizes_per_diagonal = 20;

double size_of_tag(const std::map<Tag, double>& sizes, Tag tag) {
  const auto found = sizes.find(tag);
  return found == sizes.end() ? INFINITY : Sizing::edge_per_size * found->second;
}

}  // namespace

Sizing::Sizing(const Plc& plc, const MeshOptions& options, const Frame& frame)
    : elements_across_gap_(options.elements_across_gap),
      field_(options.size_field),
      frame_(frame),
      size_min_(options.size_min) {
  if (options.elements_per_circle > 0) curved_ = curvature_sizes(plc, options.elements_per_circle);
  const double global = edge_per_size * collarmesh::default_size(plc, options);
  global_size_ = global;
  for (const Plc::Region& region : plc.regions) {
    double size = std::min(global, size_of_tag(options.region_size, region.tag));
    if (region.size > 0) size = std::min(size, edge_per_size * region.size);
    region_size_.push_back(std::max(size, size_min_));
    expected_cells_ +=
        region.volume / (0.09 * region_size_.back() * region_size_.back() * region_size_.back());
  }
  for (const Plc::Patch& patch : plc.patches) {
    const double behind = patch.regions[0] > 0 ? region_size_[patch.regions[0]] : global;
    const double front = patch.regions[1] > 0 ? region_size_[patch.regions[1]] : global;
    const double size = std::min({behind, front, size_of_tag(options.patch_size, patch.tag)});
    patch_size_.push_back(std::max(size, size_min_));
  }
  for (const Plc::Curve& curve : plc.curves) {
    double size = std::min(global, size_of_tag(options.curve_size, curve.tag));
    for (const Index patch : curve.patches) size = std::min(size, patch_size_[patch]);
    if (const std::size_t edges = least_edges(plc, curve, options.edges_per_hole); edges > 0)
      size =
          std::min(size, length_of(plc, curve) / (subsegment_length_per_edge * static_cast<double>(edges)));
    curve_size_.push_back(std::max(size, size_min_));
  }
}

double default_size(const Plc& plc, const MeshOptions& options) {
  if (options.size > 0) return options.size;
  return plc.bounds.diagonal() / (options.profile == Profile::paper ? 1 : default_sizes_per_diagonal);
}

void Sizing::refuse(double asked, const Point& place) {
  throw OptionError(
      fmt::format("size-field: the size is {} at ({:.9g}, {:.9g}, {:.9g}); sizes must be positive; infinity "
                  "asks for no size",
                  asked, place.x, place.y, place.z));
}

double Sizing::curve_size(Index curve, std::size_t first, std::size_t last, const Point& p) const {
  double size = limited(curve_size_[curve], p);
  if (curved_.curve_segment.empty() || curved_.curve_segment[curve].empty()) return size;
  const auto& segments = curved_.curve_segment[curve];
  // In a closed curve the first segment follows the last one.
  for (std::size_t i = first;; i = (i + 1) % segments.size()) {
    size = std::min(size, at_least_minimum(segments[i]));
    if (i == last) return size;
  }
}

}  // namespace collarmesh
