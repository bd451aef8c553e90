#pragma once

#include "common/spatial_order.h"

namespace collarmesh {

/// As spatial_order, by the threads of the caller's arena.
std::vector<SpatialKey> spatial_order_by_all_threads(std::span<const Point> points);

}  // namespace collarmesh
