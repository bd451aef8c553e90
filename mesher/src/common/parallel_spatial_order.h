#pragma once

#include "common/spatial_order.h"

namespace collarmesh {

/// Orders points like spatial_order, with the threads of the caller's arena.
std::vector<SpatialKey> spatial_order_by_all_threads(std::span<const Point> points);

}  // namespace collarmesh
