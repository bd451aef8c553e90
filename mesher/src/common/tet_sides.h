#pragma once

#include <array>
#include <cstdint>

#include "collarmesh/geometry.h"

namespace collarmesh {

/// For each corner of a tet, the positions of the three opposite corners, counterclockwise as seen from
/// outside.
inline constexpr std::array<std::array<std::uint8_t, 3>, 4> opposite_places{
    {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};

/// Returns the position of a corner in a tet, 0 to 3. Precondition: it is one of the corners.
inline unsigned place_of(Index corner, const std::array<Index, 4>& tet) {
  return (tet[1] == corner ? 1U : 0U) + (tet[2] == corner ? 2U : 0U) + (tet[3] == corner ? 3U : 0U);
}

/// Returns the corners of a tet's side opposite its corner of this position, 0 to 3, counterclockwise as seen
/// from outside.
inline std::array<Index, 3> side_corners(const std::array<Index, 4>& tet, unsigned corner) {
  const auto& [a, b, c] = opposite_places[corner];
  return {tet[a], tet[b], tet[c]};
}

}  // namespace collarmesh
