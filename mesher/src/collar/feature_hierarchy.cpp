#include "collar/feature_hierarchy.h"

#include <algorithm>
#include <numeric>

#include "common/segments.h"

namespace collarmesh {

FeatureHierarchy::FeatureHierarchy(const Plc& plc, std::span<const Point> points) : points_(points) {
  const auto start = [&](std::uint8_t dimension, Index index) {
    features_.push_back({dimension, index});
    first_element_.push_back(static_cast<Index>(elements_.size()));
  };
  for (Index v = 0; v < plc.vertices.size(); ++v) {
    start(0, v);
    const Index p = plc.vertices[v].point;
    elements_.push_back({p, p, p});
  }
  first_feature_[1] = static_cast<Index>(features_.size());
  for (Index c = 0; c < plc.curves.size(); ++c) {
    start(1, c);
    visit_segments(plc.curves[c], [&](Index a, Index b) { elements_.push_back({a, b, b}); });
  }
  first_feature_[2] = static_cast<Index>(features_.size());
  for (Index f = 0; f < plc.patches.size(); ++f) {
    start(2, f);
    const Plc::Patch& patch = plc.patches[f];
    for (Index t = 0; t < patch.triangle_count; ++t)
      elements_.push_back(plc.triangles[patch.first_triangle + t].points);
  }
  first_element_.push_back(static_cast<Index>(elements_.size()));

  std::vector<Box> boxes(elements_.size());
  for (std::size_t e = 0; e < elements_.size(); ++e)
    for (const Index p : elements_[e]) boxes[e].add(points_[p]);
  trees_.reserve(2 * elements_.size() + 2 * features_.size());
  std::vector<Index> order(elements_.size());
  std::iota(order.begin(), order.end(), Index{0});
  std::vector<Box> feature_boxes;
  feature_of_.resize(elements_.size());
  for (Index f = 0; f < features_.size(); ++f) {
    const Index first = first_element_[f], count = first_element_[f + 1] - first;
    std::fill_n(feature_of_.begin() + first, count, f);
    roots_.push_back(build(std::span(order).subspan(first, count), boxes));
    feature_boxes.push_back(roots_.back() == none ? Box{} : trees_.bounds(roots_.back()));
  }
  order.resize(features_.size());
  std::iota(order.begin(), order.end(), Index{0});
  std::erase_if(order, [&](Index f) { return roots_[f] == none; });
  root_ = build(order, feature_boxes);
}

Index FeatureHierarchy::build(std::span<Index> items, std::span<const Box> boxes) {
  if (items.empty()) return none;
  const Index root = trees_.node_count();
  const auto centre_of = [&](Index item) { return boxes[item].centre(); };
  trees_.add(
      0, static_cast<Index>(items.size()), 1, median_splits(items, centre_of),
      [&](Index place, Index) { return boxes[items[place]]; }, joined);
  trees_.renumber([&](Index place) { return items[place]; }, root);
  return root;
}

double FeatureHierarchy::squared_distance_to(const Point& p, Index element) const {
  const auto t = corners(element);
  return squared_distance_to_triangle(p, t[0], t[1], t[2]);
}

Point FeatureHierarchy::nearest_point(Feature feature, const Point& p) const {
  Index nearest = none;
  distance_within(feature, p, INFINITY, nearest, [](Index) { return true; });
  const auto t = corners(nearest);
  return nearest_point_on_triangle(p, t[0], t[1], t[2]);
}

}  // namespace collarmesh
