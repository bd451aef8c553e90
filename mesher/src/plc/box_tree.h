#pragma once

#include <vector>

#include "collarmesh/geometry.h"

namespace collarmesh::build {

/// A hierarchy of boxes that finds the pairs of items whose boxes meet.
class BoxTree {
 public:
  explicit BoxTree(std::vector<Box> boxes);

  /// Calls visit(i) for every item whose box meets the given box, or may.
  template <class Visit>
  void for_each_near(const Box& box, const Visit& visit) const {
    if (!nodes_.empty()) descend(0, [&](const Box& b) { return meet(b, box); }, visit);
  }

  /// Calls visit(i) for every item whose box meets the segment pq, or may.
  template <class Visit>
  void for_each_near_segment(const Point& p, const Point& q, const Visit& visit) const {
    if (!nodes_.empty()) descend(0, [&](const Box& b) { return may_meet(b, p, q); }, visit);
  }

 private:
  struct Node {
    Box box;
    Index first, count;  // items, or count 0: the children are the next node and `first`
  };
  static constexpr Index leaf_size = 4;

  static bool meet(const Box& a, const Box& b) {
    return a.min.x <= b.max.x && b.min.x <= a.max.x && a.min.y <= b.max.y && b.min.y <= a.max.y &&
           a.min.z <= b.max.z && b.min.z <= a.max.z;
  }
  // Conservative: never false when the box and the segment meet.
  static bool may_meet(const Box& box, const Point& p, const Point& q);

  Index build(Index first, Index last);

  template <class Test, class Visit>
  void descend(Index node, const Test& test, const Visit& visit) const {
    const Node& n = nodes_[node];
    if (!test(n.box)) return;
    if (n.count == 0) {
      descend(node + 1, test, visit);
      descend(n.first, test, visit);
      return;
    }
    for (Index i = n.first; i < n.first + n.count; ++i)
      if (test(boxes_[items_[i]])) visit(items_[i]);
  }

  std::vector<Box> boxes_;
  std::vector<Index> items_;
  std::vector<Node> nodes_;
};

}  // namespace collarmesh::build
