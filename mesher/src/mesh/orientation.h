#pragma once

#include "collarmesh/geometry.h"

namespace collarmesh {

/// Returns the sign of six_volume(a, b, c, d) by exact arithmetic.
int exact_orientation(const Point& a, const Point& b, const Point& c, const Point& d);

}  // namespace collarmesh
