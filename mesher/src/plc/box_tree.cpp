#include "plc/box_tree.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace collarmesh::build {

BoxTree::BoxTree(std::vector<Box> boxes) : boxes_(std::move(boxes)), items_(boxes_.size()) {
  std::iota(items_.begin(), items_.end(), Index{0});
  if (!items_.empty()) build(0, static_cast<Index>(items_.size()));
}

Index BoxTree::build(Index first, Index last) {
  const auto node = static_cast<Index>(nodes_.size());
  Box box, centres;
  for (Index i = first; i < last; ++i) {
    box.add(boxes_[items_[i]]);
    centres.add(boxes_[items_[i]].centre());
  }
  nodes_.push_back({box, first, last - first});
  if (last - first <= leaf_size) return node;
  const Vector extent = centres.max - centres.min;
  const std::size_t axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
  const Index middle = first + (last - first) / 2;
  std::nth_element(items_.begin() + first, items_.begin() + middle, items_.begin() + last,
                   [&](Index a, Index b) {
                     const double ca = boxes_[a].min[axis] + boxes_[a].max[axis],
                                  cb = boxes_[b].min[axis] + boxes_[b].max[axis];
                     return ca != cb ? ca < cb : a < b;
                   });
  build(first, middle);
  const Index right = build(middle, last);
  nodes_[node].first = right;
  nodes_[node].count = 0;
  return node;
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
