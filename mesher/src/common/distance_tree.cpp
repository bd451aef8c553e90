#include "common/distance_tree.h"

#include <algorithm>
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
  nodes_.reserve(keys.size());
  build(keys, 0);
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

Index DistanceTree::build(std::span<const SpatialKey> keys, Index first) {
  const auto node = static_cast<Index>(nodes_.size());
  nodes_.push_back({{}, first, static_cast<Index>(keys.size())});
  if (keys.size() <= leaf_size) {
    for (Index i = first; i < first + keys.size(); ++i)
      for (const Point& p : triangles_[i]) nodes_[node].box.add(p);
    return node;
  }
  const std::size_t half = spatial_split(keys);
  const Index left = build(keys.first(half), first),
              right = build(keys.subspan(half), first + static_cast<Index>(half));
  Box box = nodes_[left].box;
  box.add(nodes_[right].box);
  nodes_[node] = {box, right, 0};
  return node;
}

double DistanceTree::squared_distance_to(Index node, const Point& p) const {
  return squared_distance_to_box(p, nodes_[node].box);
}

DistanceTree::Nearest DistanceTree::nearest(const Point& p, double enough, Index hint) const {
  if (nodes_.empty()) return {INFINITY, none};
  Index best = hint == none ? 0 : place_[hint];
  double least = squared_distance_to_triangle(p, triangles_[best]);
  struct Waiting {
    Index node;
    double squared;
  };
  std::array<Waiting, most_spatial_levels + 1> stack;  // on every level, one of two children waits
  std::size_t size = 0;
  stack[size++] = {0, squared_distance_to(0, p)};
  const double squared_enough = enough * enough;
  while (size > 0 && least > squared_enough) {
    const auto [index, squared] = stack[--size];
    if (squared >= least) continue;
    const Node& node = nodes_[index];
    for (Index i = node.first; i < node.first + node.count; ++i) {
      const double d = squared_distance_to_triangle(p, triangles_[i]);
      if (d < least) {
        least = d;
        best = i;
      }
    }
    if (node.count != 0) continue;
    Waiting near{index + 1, squared_distance_to(index + 1, p)},
        far{node.first, squared_distance_to(node.first, p)};
    if (far.squared < near.squared) std::swap(near, far);
    if (far.squared < least) stack[size++] = far;
    if (near.squared < least) stack[size++] = near;
  }
  return {std::sqrt(least), number_[best]};
}

}  // namespace collarmesh
