#include "common/box_tree.h"

#include <algorithm>
#include <cmath>

namespace collarmesh {

BoxTree::BoxTree(std::span<const Box> boxes, std::span<const Index> groups) {
  if (boxes.empty()) return;
  std::vector<Point> centres;
  centres.reserve(boxes.size());
  for (const Box& box : boxes) centres.push_back(box.centre());
  const std::vector<SpatialKey> keys = spatial_order(centres);
  items_.reserve(keys.size());
  boxes_.reserve(keys.size());
  groups_.reserve(groups.size());
  for (const SpatialKey& key : keys) {
    items_.push_back(key.item);
    boxes_.push_back(boxes[key.item]);
    if (!groups.empty()) groups_.push_back(groups[key.item]);
  }
  nodes_.reserve(keys.size());
  build(keys, 0);
}

Index BoxTree::build(std::span<const SpatialKey> keys, Index first) {
  const auto node = static_cast<Index>(nodes_.size());
  const auto count = static_cast<Index>(keys.size());
  nodes_.push_back({{}, first, count, none});
  if (count <= leaf_size) {
    Node& leaf = nodes_[node];
    if (!groups_.empty()) leaf.group = groups_[first];
    for (Index i = first; i < first + count; ++i) {
      leaf.box.add(boxes_[i]);
      if (!of_one_group(i, first)) leaf.group = none;
    }
    return node;
  }
  const std::size_t half = spatial_split(keys);
  const Index left = build(keys.first(half), first),
              right = build(keys.subspan(half), first + static_cast<Index>(half));
  Box box = nodes_[left].box;
  box.add(nodes_[right].box);
  nodes_[node] = {box, right, 0, of_one_group(nodes_[left], nodes_[right]) ? nodes_[left].group : none};
  return node;
}

bool BoxTree::may_meet(const Box& box, const Point& p, const Point& q) {
  // Tests the separating axes of a box and a segment, with a margin for rounding.
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

}  // namespace collarmesh
