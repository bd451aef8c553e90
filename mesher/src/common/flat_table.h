#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "collarmesh/geometry.h"

namespace collarmesh {

/// Returns a number whose lower 32 bits depend on all bits of the key.
inline std::uint64_t spread(std::uint64_t key) { return key * 0x9e3779b97f4a7c15U >> 32U; }

/// Finds an item in a flat hash table: the slots hold numbers of items, or none, and an item is in the slot
/// of its hash or, if that was taken, in the next free one. Returns its slot, or the free slot where it
/// belongs. `is_it(number)` compares items. Preconditions: the number of slots is a power of two, and some
/// are free.
template <class IsIt>
Index& find_slot(std::span<Index> slots, std::uint64_t hash, const IsIt& is_it) {
  const std::size_t last = slots.size() - 1;
  std::size_t slot = hash & last;
  while (slots[slot] != none && !is_it(slots[slot])) slot = (slot + 1) & last;
  return slots[slot];
}

}  // namespace collarmesh
