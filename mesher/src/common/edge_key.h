#pragma once

#include <algorithm>
#include <cstdint>

#include "collarmesh/geometry.h"

namespace collarmesh {

/// Returns one number for the edge between two points, in either order. Keys are ordered by the smaller end,
/// then by the larger one.
inline std::uint64_t edge_key(Index a, Index b) {
  return std::uint64_t{std::min(a, b)} << 32U | std::max(a, b);
}

}  // namespace collarmesh
