#pragma once

#include <array>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "collarmesh/geometry.h"

namespace collarmesh::shells {

/// Divides a polygon into triangles so that their least shape (see shape_of) is as large as possible. Returns
/// their corners as indices in `polygon`, ascending; nothing if the least shape would always be below
/// `least`. `may_join` tells whether two corners that are not neighbours may be joined. Cost: cubic.
std::optional<std::vector<std::array<unsigned, 3>>> best_triangles(
    std::span<const Point> polygon, double least, const std::function<bool(unsigned, unsigned)>& may_join);

}  // namespace collarmesh::shells
