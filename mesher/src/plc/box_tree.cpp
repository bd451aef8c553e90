#include "plc/box_tree.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace collarmesh::build {

BoxTree::BoxTree(std::vector<Box> boxes) : boxes_(std::move(boxes)), items_(boxes_.size()) {
  std::iota(items_.begin(), items_.end(), Index{0});
  nodes_.reserve(items_.size());
  if (!items_.empty()) build(0, static_cast<Index>(items_.size()));
}

Index BoxTree::build(Index first, Index last) {
  const auto node = static_cast<Index>(nodes_.size());
  nodes_.push_back({boxes_[items_[first]], first, last - first});
  if (last - first <= leaf_size) {
    for (Index i = first + 1; i < last; ++i) extend(nodes_[node].box, boxes_[items_[i]]);
    return node;
  }
  const std::size_t axis = longest_axis(first, last);
  const Index middle = first + (last - first) / 2;
  std::nth_element(items_.begin() + first, items_.begin() + middle, items_.begin() + last,
                   [&](Index a, Index b) {
                     const double ca = position(a, axis), cb = position(b, axis);
                     return ca != cb ? ca < cb : a < b;
                   });
  const Index left = build(first, middle), right = build(middle, last);
  nodes_[node] = {nodes_[left].box, right, 0};
  extend(nodes_[node].box, nodes_[right].box);
  return node;
}

void BoxTree::extend(Box& box, const Box& other) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    box.min[axis] = std::min(box.min[axis], other.min[axis]);
    box.max[axis] = std::max(box.max[axis], other.max[axis]);
  }
}

std::size_t BoxTree::longest_axis(Index first, Index last) const {
  std::size_t longest = 0;
  double longest_extent = -1;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    double low = position(items_[first], axis), high = low;
    for (Index i = first + 1; i < last; ++i) {
      low = std::min(low, position(items_[i], axis));
      high = std::max(high, position(items_[i], axis));
    }
    if (high - low <= longest_extent) continue;
    longest = axis;
    longest_extent = high - low;
  }
  return longest;
}

bool BoxTree::may_meet(const Box& box, const Point& p, const Point& q) {
  // Separating axes of a box and a segment, with room for rounding.
  const Point centre = box.centre(), half = 0.5 * (box.max - box.min);
  const Vector d = 0.5 * (q - p), m = 0.5 * (p + q) - centre;
  const Vector ad{std::fabs(d.x), std::fabs(d.y), std::fabs(d.z)};
  const double scale =
      std::max({std::fabs(centre.x), std::fabs(centre.y), std::fabs(centre.z), half.x + half.y + half.z,
                ad.x + ad.y + ad.z, std::fabs(m.x), std::fabs(m.y), std::fabs(m.z)});
  const double slack = 1e-14 * scale;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (std::fabs(m[axis]) > half[axis] + ad[axis] + slack) return false;
    const std::size_t i = (axis + 1) % 3, j = (axis + 2) % 3;
    if (std::fabs(m[i] * d[j] - m[j] * d[i]) >
        half[i] * ad[j] + half[j] * ad[i] + slack * (ad[i] + ad[j] + scale))
      return false;
  }
  return true;
}

}  // namespace collarmesh::build
