#pragma once

#include "collarmesh/geometry.h"

namespace collarmesh::checks {

/// Sign of six_volume(a, b, c, d), exactly.
int exact_orientation(const Point& a, const Point& b, const Point& c, const Point& d);

}  // namespace collarmesh::checks
