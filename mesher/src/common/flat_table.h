#pragma once

#include <array>
#include <bit>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <span>

#include "collarmesh/geometry.h"
#include "common/split_mix.h"

namespace collarmesh {

/// Returns a number whose lower 32 bits depend on all bits of the key.
inline std::uint64_t spread(std::uint64_t key) { return key * split_mix_step >> 32U; }

/// Returns a hash of a sequence of whole numbers; it depends on their order.
template <class Numbers>
std::uint64_t hash_of(const Numbers& numbers) {
  std::uint64_t hash = 0;
  for (const auto number : numbers) hash = mixed(hash + split_mix_step + static_cast<std::uint64_t>(number));
  return hash;
}
/// Returns a hash of a point. Equal points have equal hashes, even if one has -0 in place of 0.
inline std::uint64_t hash_of(const Point& p) {
  const auto bits = [](double x) { return std::bit_cast<std::uint64_t>(x + 0.0); };
  return hash_of(std::array{bits(p.x), bits(p.y), bits(p.z)});
}

/// Finds an item in a flat hash table: the slots hold numbers of items, or none, and an item is in the slot
/// of its hash or, if that was taken, in the next free one. Returns its slot, or the free slot where it
/// belongs. `is_it(number)` tells whether an item is the one to find. Preconditions: the number of slots is a
/// power of two, and some are free.
template <class IsIt>
Index& find_slot(std::span<Index> slots, std::uint64_t hash, const IsIt& is_it) {
  assert(std::has_single_bit(slots.size()));
  const std::size_t last = slots.size() - 1;
  std::size_t slot = hash & last;
  while (slots[slot] != none && !is_it(slots[slot])) slot = (slot + 1) & last;
  return slots[slot];
}

}  // namespace collarmesh
