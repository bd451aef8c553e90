#pragma once

#include <span>
#include <vector>

#include "collarmesh/geometry.h"
#include "common/hierarchy.h"

namespace collarmesh {

/// A hierarchy of boxes that finds pairs of items whose boxes meet, and the items near a segment.
class BoxTree {
 public:
  /// Builds the tree. Items may belong to groups, numbered in any way; without groups each item is a group.
  /// Cost: O(n) for n items.
  explicit BoxTree(std::span<const Box> boxes, std::span<const Index> groups = {});

  /// Calls visit(i, j) once for every pair of items of different groups whose boxes meet.
  template <class Visit>
  void for_each_pair(const Visit& visit) const {
    if (!tree_.empty()) pairs_within(0, visit);
  }

  /// Calls visit(i) for every item whose box meets `box`.
  template <class Visit>
  void for_each_meeting(const Box& box, const Visit& visit) const {
    descend([&](const Box& b) { return boxes_meet(b, box); }, visit);
  }

  /// Calls visit(i) for every item whose box meets the segment pq, and perhaps for some others.
  template <class Visit>
  void for_each_near_segment(const Point& p, const Point& q, const Visit& visit) const {
    descend([&](const Box& b) { return may_meet(b, p, q); }, visit);
  }

 private:
  struct Bounds {
    Box box;
    Index group = none;  // group of all items; none if their groups differ
  };
  static constexpr Index leaf_size = 4;

  // Tests conservatively: never returns false when the box and the segment meet.
  static bool may_meet(const Box& box, const Point& p, const Point& q);

  Bounds bounds_of(Index first, Index count) const;
  // Returns whether all items below both nodes are of one group.
  static bool of_one_group(const Bounds& a, const Bounds& b) { return a.group != none && a.group == b.group; }
  bool of_one_group(Index i, Index j) const { return !groups_.empty() && groups_[i] == groups_[j]; }
  template <class Visit>
  void visit_pair(Index i, Index j, const Visit& visit) const {
    if (boxes_meet(boxes_[i], boxes_[j]) && !of_one_group(i, j)) visit(items_[i], items_[j]);
  }

  template <class Test, class Visit>
  void descend(const Test& test, const Visit& visit) const {
    if (tree_.empty()) return;
    tree_.descend(
        0, [&](const Bounds& bounds) { return test(bounds.box); },
        [&](Index i) {
          if (test(boxes_[i])) visit(items_[i]);
        });
  }

  template <class Visit>
  void pairs_within(Index node, const Visit& visit) const {
    if (tree_.bounds(node).group != none) return;
    if (!tree_.is_leaf(node)) {
      pairs_within(tree_.left(node), visit);
      pairs_within(tree_.right(node), visit);
      pairs_between(tree_.left(node), tree_.right(node), visit);
      return;
    }
    for (Index i = tree_.first(node); i < tree_.end(node); ++i)
      for (Index j = i + 1; j < tree_.end(node); ++j) visit_pair(i, j, visit);
  }

  template <class Visit>
  void pairs_between(Index a, Index b, const Visit& visit) const {
    const Bounds &of_a = tree_.bounds(a), &of_b = tree_.bounds(b);
    if (of_one_group(of_a, of_b) || !boxes_meet(of_a.box, of_b.box)) return;
    if (!tree_.is_leaf(a)) {
      pairs_between(tree_.left(a), b, visit);
      pairs_between(tree_.right(a), b, visit);
    } else if (!tree_.is_leaf(b)) {
      pairs_between(a, tree_.left(b), visit);
      pairs_between(a, tree_.right(b), visit);
    } else {
      for (Index i = tree_.first(a); i < tree_.end(a); ++i)
        for (Index j = tree_.first(b); j < tree_.end(b); ++j) visit_pair(i, j, visit);
    }
  }

  // Items in the order of the leaves, and their groups and boxes:
  std::vector<Index> items_;
  std::vector<Box> boxes_;
  std::vector<Index> groups_;
  Hierarchy<Bounds> tree_;
};

}  // namespace collarmesh
