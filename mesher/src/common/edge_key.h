#pragma once

#include <algorithm>
#include <cstdint>

#include "collarmesh/geometry.h"

namespace collarmesh {

/// Returns one number for a pair. Keys are ordered by the first number, then by the second one.
inline std::uint64_t pair_key(Index a, Index b) { return std::uint64_t{a} << 32U | b; }

/// Returns one number for the edge between two points, in either order. Keys are ordered by the smaller end,
/// then by the larger one.
inline std::uint64_t edge_key(Index a, Index b) { return pair_key(std::min(a, b), std::max(a, b)); }

}  // namespace collarmesh
