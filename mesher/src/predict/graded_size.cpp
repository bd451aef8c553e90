#include "predict/graded_size.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "common/distances.h"

namespace collarmesh::prediction {

namespace {

Point centre(const GradedSize::Source& s) { return (s.corners[0] + s.corners[1] + s.corners[2]) / 3; }

}  // namespace

GradedSize::GradedSize(std::vector<Source> sources) : sources_(std::move(sources)) {
  for (const Source& source : sources_) growth_ = std::max(growth_, source.growth);
  if (sources_.empty()) return;
  constexpr Index leaf_size = 4;
  const auto bounds_of = [&](Index first, Index count) {
    Bounds bounds;
    for (const Source& source : std::span(sources_).subspan(first, count)) {
      for (const Point& p : source.corners) bounds.box.add(p);
      bounds.least = std::min(bounds.least, source.size);
      bounds.growth = std::min(bounds.growth, source.growth);
    }
    return bounds;
  };
  tree_.add(0, static_cast<Index>(sources_.size()), leaf_size, median_splits(std::span(sources_), centre),
            bounds_of, [](const Bounds& a, const Bounds& b) {
              return Bounds{joined(a.box, b.box), std::min(a.least, b.least), std::min(a.growth, b.growth)};
            });
}

double GradedSize::at(const Point& p, double largest) const {
  double size = largest;
  if (tree_.empty()) return size;
  const auto lowest = [&](Index node) {
    const Bounds& b = tree_.bounds(node);
    return b.least >= size ? b.least : b.least + b.growth * std::sqrt(squared_distance_to_box(p, b.box));
  };
  tree_.visit_near(0, size, lowest, [&](Index i) {
    const auto& [corners, least, growth] = sources_[i];
    const auto& [a, b, c] = corners;
    if (least >= size) return;
    size = std::min(size, least + growth * std::sqrt(squared_distance_to_triangle(p, a, b, c)));
  });
  return size;
}

}  // namespace collarmesh::prediction
