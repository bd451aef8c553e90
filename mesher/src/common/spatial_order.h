#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "collarmesh/geometry.h"

namespace collarmesh {

/// An item and its place along a Z-shaped curve through the cells of an octree (Morton 1966): items close to
/// each other along the curve are close in space.
struct SpatialKey {
  std::uint64_t place;
  Index item;
};

/// Returns the items 0, 1, ... at these points in the order of the curve. Each axis has 2^21 cells; items in
/// one cell are ordered by finer cells, and items at one point by number. If the extent is out of a double's
/// range, all items are ordered by number. Cost: O(n) for every factor of 2^21 in the ratio of the extent to
/// the least distance.
std::vector<SpatialKey> spatial_order(std::span<const Point> points);
/// Orders points like spatial_order, with the threads of the caller's arena.
std::vector<SpatialKey> spatial_order_by_all_threads(std::span<const Point> points);

/// Returns the position at which a hierarchy over items in spatial order splits them: the first one in the
/// upper half of the smallest octree cell that holds them all, or the middle one if all are at one place.
/// Precondition: there are at least two items.
std::size_t spatial_split(std::span<const SpatialKey> keys);

/// The maximum depth of a hierarchy made by `spatial_split`.
inline constexpr std::size_t most_spatial_levels = 63 + 32;

}  // namespace collarmesh
