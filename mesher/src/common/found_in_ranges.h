#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "common/parallel_for.h"

namespace collarmesh {

/// Collects the items that `look(i, found)` adds to `found` for all i below `count`, in the order of i. The
/// threads of the caller's arena call `look`.
template <class Found, class Look>
std::vector<Found> found_in_ranges(std::size_t count, const Look& look,
                                   const recorded_costs::Place& place = {__builtin_FILE(),
                                                                         __builtin_LINE()}) {
  constexpr std::size_t at_once = 4096;
  std::vector<std::vector<Found>> of_ranges((count + at_once - 1) / at_once);
  parallel_for_ranges(
      count, at_once,
      [&](std::size_t first, std::size_t last) {
        std::vector<Found> found;
        for (std::size_t i = first; i < last; ++i) look(i, found);
        of_ranges[first / at_once] = std::move(found);
      },
      place);
  std::size_t size = 0;
  for (const auto& found : of_ranges) size += found.size();
  std::vector<Found> all;
  all.reserve(size);
  for (auto& found : of_ranges) {
    all.insert(all.end(), found.begin(), found.end());
    std::vector<Found>().swap(found);
  }
  return all;
}

}  // namespace collarmesh
