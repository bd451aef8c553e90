#include "predict/graded_size.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "location/triangle_hierarchy.h"

namespace collarmesh::prediction {

namespace {

Point centre(const GradedSize::Source& s) { return (s.corners[0] + s.corners[1] + s.corners[2]) / 3; }

}  // namespace

GradedSize::GradedSize(std::vector<Source> sources) : sources_(std::move(sources)) {
  for (const Source& source : sources_) growth_ = std::max(growth_, source.growth);
  if (!sources_.empty()) build(0, static_cast<Index>(sources_.size()));
}

Index GradedSize::build(Index first, Index last) {
  const auto node = static_cast<Index>(nodes_.size());
  nodes_.push_back({{}, INFINITY, INFINITY, first, last - first});
  Box box, centres;
  double least = INFINITY, growth = INFINITY;
  for (Index i = first; i < last; ++i) {
    for (const Point& p : sources_[i].corners) box.add(p);
    centres.add(centre(sources_[i]));
    least = std::min(least, sources_[i].size);
    growth = std::min(growth, sources_[i].growth);
  }
  nodes_[node].box = box;
  nodes_[node].least = least;
  nodes_[node].growth = growth;
  if (last - first <= leaf_size) return node;
  const Vector extent = centres.max - centres.min;
  const std::size_t axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
  const Index middle = first + (last - first) / 2;
  std::nth_element(sources_.begin() + first, sources_.begin() + middle, sources_.begin() + last,
                   [axis](const Source& a, const Source& b) { return centre(a)[axis] < centre(b)[axis]; });
  build(first, middle);
  const Index right = build(middle, last);
  nodes_[node].first = right;
  nodes_[node].count = 0;
  return node;
}

double GradedSize::at(const Point& p, double largest) const {
  double size = largest;
  if (nodes_.empty()) return size;
  const auto lowest = [&](Index node) {
    const Node& n = nodes_[node];
    return n.least >= size ? n.least : n.least + n.growth * std::sqrt(squared_distance_to_box(p, n.box));
  };
  // The stack of the halves that remain is as deep as an index has bits.
  std::array<std::pair<Index, double>, 8 * sizeof(Index) + 2> stack;
  std::size_t top = 0;
  stack[top++] = {0, lowest(0)};
  while (top > 0) {
    const auto [node, low] = stack[--top];
    if (low >= size) continue;
    const Node& n = nodes_[node];
    for (Index i = n.first; i < n.first + n.count; ++i) {
      const auto& [corners, least, growth] = sources_[i];
      const auto& [a, b, c] = corners;
      if (least >= size) continue;
      size = std::min(size, least + growth * std::sqrt(squared_distance_to_triangle(p, a, b, c)));
    }
    if (n.count > 0) continue;
    const std::pair<Index, double> left{node + 1, lowest(node + 1)}, right{n.first, lowest(n.first)};
    stack[top++] = left.second < right.second ? right : left;
    stack[top++] = left.second < right.second ? left : right;
  }
  return size;
}

}  // namespace collarmesh::prediction
