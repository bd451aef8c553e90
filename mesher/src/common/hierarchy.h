#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <concepts>
#include <cstddef>
#include <span>
#include <type_traits>
#include <utility>

#include "collarmesh/geometry.h"
#include "common/large_pages.h"
#include "common/spatial_order.h"

namespace collarmesh {

/// The order in which searches visit children if nothing else decides: the left one first, or the right one.
enum class ChildOrder { left_first, right_first };

/// A binary tree over a sequence of items. Every node has bounds of the items below it, which let searches
/// skip the node. Its users define items and bounds.
template <class Bounds>
class Hierarchy {
 public:
  bool empty() const { return nodes_.empty(); }
  Index node_count() const { return static_cast<Index>(nodes_.size()); }
  std::size_t bytes() const { return nodes_.capacity() * sizeof(Node); }
  void reserve(std::size_t nodes) { nodes_.reserve(nodes); }

  const Bounds& bounds(Index node) const { return nodes_[node].bounds; }
  Bounds& bounds(Index node) { return nodes_[node].bounds; }
  bool is_leaf(Index node) const { return nodes_[node].count != 0; }
  /// Return the children of a node that is no leaf.
  Index left(Index node) const {
    assert(!is_leaf(node));
    return node + 1;
  }
  Index right(Index node) const {
    assert(!is_leaf(node));
    return nodes_[node].first;
  }
  /// Returns the first item of a leaf.
  Index first(Index leaf) const {
    assert(is_leaf(leaf));
    return nodes_[leaf].first;
  }
  /// Returns the end of the items of a leaf.
  Index end(Index leaf) const {
    assert(is_leaf(leaf));
    return nodes_[leaf].first + nodes_[leaf].count;
  }

  /// Adds a tree over `count` items, at least one, from `first` on. Its root is the next node. Leaves have at
  /// most `leaf_size` items. `split(first, count)` returns how many of these items go to the left child; it
  /// may reorder them. `leaf(first, count)` returns the bounds of these items, and `join(bounds, bounds)`
  /// those of two sets together; both are converted to `Bounds`. Returns the bounds of all items.
  template <class Split, class Leaf, class Join>
  auto add(Index first, Index count, Index leaf_size, const Split& split, const Leaf& leaf, const Join& join)
      -> std::invoke_result_t<const Leaf&, Index, Index> {
    assert(count > 0);
    const Index node = node_count();
    nodes_.push_back({{}, first, count});
    if (count <= leaf_size) {
      const auto all = leaf(first, count);
      nodes_[node].bounds = Bounds(all);
      return all;
    }
    const auto half = static_cast<Index>(split(first, count));
    const auto left = add(first, half, leaf_size, split, leaf, join);
    const Index right_node = node_count();
    const auto all = join(left, add(first + half, count - half, leaf_size, split, leaf, join));
    nodes_[node] = {Bounds(all), right_node, 0};
    return all;
  }

  /// Replaces the item i of each leaf, among the nodes from `from` on, by `item(i)`. Precondition: leaves
  /// have one item.
  template <class Item>
  void renumber(const Item& item, Index from = 0) {
    for (Index node = from; node < node_count(); ++node)
      if (is_leaf(node)) {
        assert(nodes_[node].count == 1);
        nodes_[node].first = item(nodes_[node].first);
      }
  }

  /// Visits the items of leaves below a node. `narrow(bounds, state)` returns the state for the nodes below a
  /// node, or 0 or false to skip them. `visit(item, state)` may return true to end the search. Returns
  /// whether a visit ended it.
  template <ChildOrder order = ChildOrder::left_first, class State, class Narrow, class Visit>
  bool descend(Index start, State state, const Narrow& narrow, const Visit& visit) const {
    struct Waiting {
      Index node;
      State state;
    };
    std::array<Waiting, most_spatial_levels + 1> stack;  // on every level, one of two children waits
    std::size_t size = 0;
    stack[size++] = {start, state};
    while (size > 0) {
      const auto [node, above] = stack[--size];
      const State below = narrow(nodes_[node].bounds, above);
      if (!below) continue;
      if (!is_leaf(node)) {
        const bool left_first = order == ChildOrder::left_first;
        stack[size++] = {left_first ? right(node) : left(node), below};
        stack[size++] = {left_first ? left(node) : right(node), below};
        continue;
      }
      for (Index item = first(node); item < end(node); ++item) {
        if constexpr (std::same_as<decltype(visit(item, below)), bool>) {
          if (visit(item, below)) return true;
        } else {
          visit(item, below);
        }
      }
    }
    return false;
  }

  /// Visits the items of leaves below a node; skips nodes whose bounds `meets` rejects.
  template <ChildOrder order = ChildOrder::left_first, class Meets, class Visit>
  bool descend(Index start, const Meets& meets, const Visit& visit) const {
    return descend<order>(
        start, true, [&](const Bounds& bounds, bool) { return meets(bounds); },
        [&](Index item, bool) { return visit(item); });
  }

  /// Visits the items of leaves below a node, near nodes first. Skips nodes whose `distance(node)` is not
  /// below `bound`, which `visit` may lower. `ties` tells which of two equally near children comes first.
  template <ChildOrder ties = ChildOrder::right_first, class Distance, class Visit>
  void visit_near(Index start, const double& bound, const Distance& distance, const Visit& visit) const {
    struct Waiting {
      Index node;
      double distance;
    };
    std::array<Waiting, most_spatial_levels + 1> stack;
    std::size_t size = 0;
    stack[size++] = {start, distance(start)};
    while (size > 0) {
      const Waiting next = stack[--size];
      if (next.distance >= bound) continue;
      if (is_leaf(next.node)) {
        for (Index item = first(next.node); item < end(next.node); ++item) visit(item);
        continue;
      }
      Waiting near{left(next.node), distance(left(next.node))},
          far{right(next.node), distance(right(next.node))};
      if (ties == ChildOrder::right_first ? !(near.distance < far.distance) : far.distance < near.distance)
        std::swap(near, far);
      if (far.distance < bound) stack[size++] = far;
      if (near.distance < bound) stack[size++] = near;
    }
  }

 private:
  struct Node {
    Bounds bounds;
    Index first, count;  // a leaf's items; count 0: the children are the next node and the node `first`
  };
  LargeVector<Node> nodes_;
};

/// Returns the box around two boxes; for Hierarchy::add.
inline Box joined(Box a, const Box& b) {
  a.add(b);
  return a;
}

inline bool boxes_meet(const Box& a, const Box& b) {
  return a.min.x <= b.max.x && b.min.x <= a.max.x && a.min.y <= b.max.y && b.min.y <= a.max.y &&
         a.min.z <= b.max.z && b.min.z <= a.max.z;
}

/// Returns a `split` for Hierarchy::add, for items that are in spatial order.
inline auto spatial_splits(std::span<const SpatialKey> keys) {
  return [keys](Index first, Index count) { return spatial_split(keys.subspan(first, count)); };
}

/// Returns a `split` for Hierarchy::add that halves items along the longest side of the box of their centres.
/// It reorders the items.
template <class Item, class CentreOf>
auto median_splits(std::span<Item> items, const CentreOf& centre_of) {
  return [items, &centre_of](Index first, Index count) {
    const std::span<Item> part = items.subspan(first, count);
    Box centres;
    for (const Item& item : part) centres.add(centre_of(item));
    const Vector sides = centres.max - centres.min;
    const std::size_t axis = sides.x >= sides.y && sides.x >= sides.z ? 0 : sides.y >= sides.z ? 1 : 2;
    const auto half = static_cast<std::ptrdiff_t>(count / 2);
    std::nth_element(part.begin(), part.begin() + half, part.end(), [&](const Item& a, const Item& b) {
      const double x = centre_of(a)[axis], y = centre_of(b)[axis];
      if constexpr (std::totally_ordered<Item>) return x != y ? x < y : a < b;
      return x < y;
    });
    return half;
  };
}

}  // namespace collarmesh
