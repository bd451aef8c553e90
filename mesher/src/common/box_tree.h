#pragma once

#include <span>
#include <vector>

#include "collarmesh/geometry.h"
#include "common/spatial_order.h"

namespace collarmesh {

/// A hierarchy of boxes that finds pairs of items whose boxes meet, and the items near a segment.
class BoxTree {
 public:
  /// Builds the tree. Items may belong to groups, numbered in any way; without groups each item is a group.
  /// Cost: O(n).
  explicit BoxTree(std::span<const Box> boxes, std::span<const Index> groups = {});

  /// Calls visit(i, j) once for every pair of items of different groups whose boxes meet.
  template <class Visit>
  void for_each_pair(const Visit& visit) const {
    if (!nodes_.empty()) pairs_within(0, visit);
  }

  /// Calls visit(i) for every item whose box meets this one.
  template <class Visit>
  void for_each_meeting(const Box& box, const Visit& visit) const {
    if (!nodes_.empty())
      descend(
          0, [&](const Box& b) { return meet(b, box); }, visit);
  }

  /// Calls visit(i) for every item whose box meets the segment pq, and perhaps for some others.
  template <class Visit>
  void for_each_near_segment(const Point& p, const Point& q, const Visit& visit) const {
    if (!nodes_.empty())
      descend(
          0, [&](const Box& b) { return may_meet(b, p, q); }, visit);
  }

 private:
  struct Node {
    Box box;
    Index first, count;  // its items; count 0: the children are the next node and the node `first`
    Index group;         // group of all its items, none if they differ
  };
  static constexpr Index leaf_size = 4;

  static bool meet(const Box& a, const Box& b) {
    return a.min.x <= b.max.x && b.min.x <= a.max.x && a.min.y <= b.max.y && b.min.y <= a.max.y &&
           a.min.z <= b.max.z && b.min.z <= a.max.z;
  }
  // Tests conservatively: never returns false when the box and the segment meet.
  static bool may_meet(const Box& box, const Point& p, const Point& q);

  Index build(std::span<const SpatialKey> keys, Index first);
  // Returns whether all items below both nodes are of one group.
  static bool of_one_group(const Node& a, const Node& b) { return a.group != none && a.group == b.group; }
  bool of_one_group(Index i, Index j) const { return !groups_.empty() && groups_[i] == groups_[j]; }
  template <class Visit>
  void visit_pair(Index i, Index j, const Visit& visit) const {
    if (meet(boxes_[i], boxes_[j]) && !of_one_group(i, j)) visit(items_[i], items_[j]);
  }

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
      if (test(boxes_[i])) visit(items_[i]);
  }

  template <class Visit>
  void pairs_within(Index node, const Visit& visit) const {
    const Node& n = nodes_[node];
    if (n.group != none) return;
    if (n.count == 0) {
      pairs_within(node + 1, visit);
      pairs_within(n.first, visit);
      pairs_between(node + 1, n.first, visit);
      return;
    }
    for (Index i = n.first; i < n.first + n.count; ++i)
      for (Index j = i + 1; j < n.first + n.count; ++j) visit_pair(i, j, visit);
  }

  template <class Visit>
  void pairs_between(Index a, Index b, const Visit& visit) const {
    const Node &m = nodes_[a], &n = nodes_[b];
    if (of_one_group(m, n) || !meet(m.box, n.box)) return;
    if (m.count == 0) {
      pairs_between(a + 1, b, visit);
      pairs_between(m.first, b, visit);
    } else if (n.count == 0) {
      pairs_between(a, b + 1, visit);
      pairs_between(a, n.first, visit);
    } else {
      for (Index i = m.first; i < m.first + m.count; ++i)
        for (Index j = n.first; j < n.first + n.count; ++j) visit_pair(i, j, visit);
    }
  }

  // Items in the order of the leaves, and their groups and boxes:
  std::vector<Index> items_;
  std::vector<Box> boxes_;
  std::vector<Index> groups_;
  std::vector<Node> nodes_;
};

}  // namespace collarmesh
