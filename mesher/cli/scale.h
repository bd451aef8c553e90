#pragma once

#include <vector>

#include "collarmesh/geometry.h"

namespace collarmesh::cli {

/// Change the unit of length of what is written.
inline void scale(std::vector<Point>& points, double factor) {
  if (factor == 1) return;
  for (Point& p : points) p = {factor * p.x, factor * p.y, factor * p.z};
}

}  // namespace collarmesh::cli
