#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

#include "collarmesh/geometry.h"

namespace collarmesh {

/// Returns the ends of an edge, the smaller one first.
inline std::array<Index, 2> sorted(Index a, Index b) { return {std::min(a, b), std::max(a, b)}; }

/// Sorts the few corners of a cell.
template <std::size_t corner_count>
std::array<Index, corner_count> sorted(std::array<Index, corner_count> corners) {
  for (std::size_t last = 1; last < corner_count; ++last)
    for (std::size_t i = last; i > 0 && corners[i] < corners[i - 1]; --i)
      std::swap(corners[i], corners[i - 1]);
  return corners;
}

}  // namespace collarmesh
