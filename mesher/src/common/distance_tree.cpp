#include "common/distance_tree.h"

#include <utility>

#include "common/distances.h"

namespace collarmesh {

namespace {

double squared_distance_to_triangle(const Point& p, const DistanceTree::Triangle& t) {
  return collarmesh::squared_distance_to_triangle(p, t[0], t[1], t[2]);
}

}  // namespace

DistanceTree::DistanceTree(std::vector<Triangle> triangles) : triangles_(std::move(triangles)) {
  if (triangles_.empty()) return;
  std::vector<Point> centres;
  centres.reserve(triangles_.size());
  for (const auto& [a, b, c] : triangles_) centres.push_back((a + b + c) / 3);
  const std::vector<SpatialKey> keys = spatial_order(centres);
  place_.resize(keys.size());
  number_.reserve(keys.size());
  for (const SpatialKey& key : keys) {
    place_[key.item] = static_cast<Index>(number_.size());
    number_.push_back(key.item);
  }
  put_in_order();
  tree_.reserve(keys.size());
  constexpr Index leaf_size = 2;
  const auto box_of = [&](Index first, Index count) {
    Box box;
    for (Index i = first; i < first + count; ++i)
      for (const Point& p : triangles_[i]) box.add(p);
    return box;
  };
  tree_.add(0, static_cast<Index>(keys.size()), leaf_size, spatial_splits(keys), box_of, joined);
}

// Permutes the triangles in place, along the cycles of the permutation.
void DistanceTree::put_in_order() {
  std::vector<bool> in_place(number_.size(), false);
  for (Index start = 0; start < number_.size(); ++start) {
    if (in_place[start]) continue;
    const Triangle first = triangles_[start];
    Index at = start;
    for (in_place[at] = true; number_[at] != start; in_place[at] = true) {
      triangles_[at] = triangles_[number_[at]];
      at = number_[at];
    }
    triangles_[at] = first;
  }
}

DistanceTree::Nearest DistanceTree::nearest(const Point& p, double enough, Index hint) const {
  if (tree_.empty()) return {INFINITY, none};
  Index best = hint == none ? 0 : place_[hint];
  double least = squared_distance_to_triangle(p, triangles_[best]);
  const auto bound_of = [&] { return least > enough * enough ? least : 0; };
  double bound = bound_of();
  const auto look_at = [&](Index i) {
    const double squared = squared_distance_to_triangle(p, triangles_[i]);
    if (!(squared < least)) return;
    least = squared;
    best = i;
    bound = bound_of();
  };
  tree_.visit_near<ChildOrder::left_first>(
      0, bound, [&](Index node) { return squared_distance_to_box(p, tree_.bounds(node)); }, look_at);
  return {std::sqrt(least), number_[best]};
}

}  // namespace collarmesh
