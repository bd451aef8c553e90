#pragma once

#include <cmath>

#include "collarmesh/geometry.h"

namespace collarmesh {

inline bool is_finite(const Point& p) {
  return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

}  // namespace collarmesh
