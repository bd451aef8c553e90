#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "common/box_tree.h"

namespace collarmesh::repairing {

template <class Item, class BoxOf>
std::vector<Box> boxes_of(const std::vector<Item>& items, const BoxOf& box_of) {
  std::vector<Box> boxes;
  boxes.reserve(items.size());
  for (const Item& item : items) boxes.push_back(box_of(item));
  return boxes;
}

/// Trees of the boxes of items (such as edges) that belong to numbered triangles: a large one, and one for
/// items of triangles that were added later. They may contain items that no longer exist, and some items
/// twice.
template <class Item>
class ItemTrees {
 public:
  bool empty() const { return !all_.tree; }

  /// Updates the trees, so that they have the items of all triangles. `items_from(t)` returns the items of
  /// triangles from number t on, `box_of(item)` an item's box; `end` is one more than the largest number,
  /// `count` the number of triangles.
  template <class ItemsFrom, class BoxOf>
  void renew(Index end, std::size_t count, const ItemsFrom& items_from, const BoxOf& box_of) {
    if (empty() || few * (end - all_.end) > count) all_.build(items_from(0), box_of, end);
    if (end > all_.end)
      late_.build(items_from(all_.end), box_of, end);
    else
      late_ = Tree();
  }

  /// Calls visit(item) for the items whose boxes meet the given box.
  template <class Visit>
  void for_each_meeting(const Box& box, const Visit& visit) const {
    for (const Tree* part : {&all_, &late_})
      if (part->tree) part->tree->for_each_meeting(box, [&](Index i) { visit(part->items[i]); });
  }

 private:
  // A new large tree is built when more than one triangle in `few` has been added since the last one.
  static constexpr std::size_t few = 8;

  struct Tree {
    std::vector<Item> items;
    std::unique_ptr<BoxTree> tree;
    Index end = 0;  // the tree `all_` has the items of triangles below this number

    template <class BoxOf>
    void build(std::vector<Item> new_items, const BoxOf& box_of, Index new_end) {
      items = std::move(new_items);
      end = new_end;
      tree = std::make_unique<BoxTree>(boxes_of(items, box_of));
    }
  };

  Tree all_, late_;
};

}  // namespace collarmesh::repairing
