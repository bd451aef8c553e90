#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "collarmesh/geometry.h"

namespace collarmesh {

/// A set of numbers below `none`; small sets, which are most frequent, allocate no memory.
class IndexSet {
 public:
  IndexSet() { few_.fill(none); }
  IndexSet(const IndexSet&) = delete;
  IndexSet& operator=(const IndexSet&) = delete;

  /// Adds a number; returns false if it is there already.
  bool insert(Index i) {
    if (2 * (size_ + 1) > table_.size()) grow();
    if (!insert_into(table_, i)) return false;
    ++size_;
    return true;
  }
  bool contains(Index i) const {
    const std::size_t last = table_.size() - 1;
    std::size_t slot = first_slot(i) & last;
    while (table_[slot] != i && table_[slot] != none) slot = (slot + 1) & last;
    return table_[slot] == i;
  }

 private:
  static std::size_t first_slot(Index i) { return i * 0x9e3779b97f4a7c15U >> 32U; }
  static bool insert_into(std::span<Index> table, Index i) {
    const std::size_t last = table.size() - 1;
    for (std::size_t slot = first_slot(i) & last;; slot = (slot + 1) & last) {
      if (table[slot] == i) return false;
      if (table[slot] != none) continue;
      table[slot] = i;
      return true;
    }
  }

  void grow() {
    std::vector<Index> larger(2 * table_.size(), none);
    for (const Index i : table_)
      if (i != none) insert_into(larger, i);
    many_.swap(larger);
    table_ = many_;
  }

  std::array<Index, 256> few_;
  std::vector<Index> many_;
  std::span<Index> table_ = few_;
  std::size_t size_ = 0;
};

}  // namespace collarmesh
