#include "plc/box_tree.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

namespace collarmesh::build {

namespace {

/// Where an item is: twice its box' centre. Kept beside the item, so that ranges of items are read in order.
struct Place {
  Point centre;
  Index item;
};

std::size_t longest_axis(std::span<const Place> places) {
  Box box;
  for (const Place& place : places) box.add(place.centre);
  const Vector extent = box.max - box.min;
  if (extent.x >= extent.y && extent.x >= extent.z) return 0;
  return extent.y >= extent.z ? 1 : 2;
}

}  // namespace

class BoxTree::Builder {
 public:
  explicit Builder(BoxTree& tree) : tree_(tree) {
    places_.reserve(tree.boxes_.size());
    for (Index i = 0; i < tree.boxes_.size(); ++i)
      places_.push_back({tree.boxes_[i].min + tree.boxes_[i].max, i});
  }

  void run() {
    tree_.nodes_.reserve(places_.size());
    if (!places_.empty()) build(0, static_cast<Index>(places_.size()));
    for (const Place& place : places_) tree_.items_.push_back(place.item);
  }

 private:
  Index build(Index first, Index last) {
    const auto node = static_cast<Index>(tree_.nodes_.size());
    tree_.nodes_.push_back({box(first), first, last - first});
    if (last - first <= leaf_size) {
      for (Index i = first + 1; i < last; ++i) extend(tree_.nodes_[node].box, box(i));
      return node;
    }
    const std::size_t axis = longest_axis(std::span(places_).subspan(first, last - first));
    const Index middle = first + (last - first) / 2;
    std::nth_element(places_.begin() + first, places_.begin() + middle, places_.begin() + last,
                     [axis](const Place& a, const Place& b) {
                       const double ca = a.centre[axis], cb = b.centre[axis];
                       return ca != cb ? ca < cb : a.item < b.item;
                     });
    const Index left = build(first, middle), right = build(middle, last);
    tree_.nodes_[node] = {tree_.nodes_[left].box, right, 0};
    extend(tree_.nodes_[node].box, tree_.nodes_[right].box);
    return node;
  }

  const Box& box(Index place) const { return tree_.boxes_[places_[place].item]; }

  BoxTree& tree_;
  std::vector<Place> places_;
};

BoxTree::BoxTree(std::vector<Box> boxes) : boxes_(std::move(boxes)) {
  items_.reserve(boxes_.size());
  Builder(*this).run();
}

void BoxTree::extend(Box& box, const Box& other) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    box.min[axis] = std::min(box.min[axis], other.min[axis]);
    box.max[axis] = std::max(box.max[axis], other.max[axis]);
  }
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
