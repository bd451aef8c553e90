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
  tree_.reserve(keys.size());
  tree_.add(
      0, static_cast<Index>(keys.size()), leaf_size, spatial_splits(keys),
      [&](Index first, Index count) { return bounds_of(first, count); },
      [](const Bounds& a, const Bounds& b) {
        return Bounds{joined(a.box, b.box), of_one_group(a, b) ? a.group : none};
      });
}

BoxTree::Bounds BoxTree::bounds_of(Index first, Index count) const {
  Bounds bounds;
  if (!groups_.empty()) bounds.group = groups_[first];
  for (Index i = first; i < first + count; ++i) {
    bounds.box.add(boxes_[i]);
    if (!of_one_group(i, first)) bounds.group = none;
  }
  return bounds;
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
