#pragma once

#include <array>
#include <cassert>
#include <cstddef>
#include <span>
#include <vector>

#include "collarmesh/geometry.h"
#include "common/flat_table.h"

namespace collarmesh {

/// A set of numbers below `none`. Most sets are small, and small ones allocate no memory.
class IndexSet {
 public:
  IndexSet() { few_.fill(none); }
  IndexSet(const IndexSet&) = delete;
  IndexSet& operator=(const IndexSet&) = delete;

  /// Adds a number; returns false if it is there already.
  bool insert(Index i) {
    assert(i != none);
    if (2 * (size_ + 1) > table_.size()) grow();
    Index& slot = slot_of(table_, i);
    if (slot == i) return false;
    slot = i;
    ++size_;
    return true;
  }
  bool contains(Index i) const { return slot_of(table_, i) == i; }

 private:
  static Index& slot_of(std::span<Index> table, Index i) {
    return find_slot(table, spread(i), [&](Index other) { return other == i; });
  }

  void grow() {
    std::vector<Index> larger(2 * table_.size(), none);
    for (const Index i : table_)
      if (i != none) slot_of(larger, i) = i;
    many_.swap(larger);
    table_ = many_;
  }

  std::array<Index, 256> few_;
  std::vector<Index> many_;
  std::span<Index> table_ = few_;
  std::size_t size_ = 0;
};

}  // namespace collarmesh
