#pragma once

#include <fmt/format.h>

#include <vector>

#include "common/is_finite.h"

namespace collarmesh::io {

/// Returns the points with these coordinates (x, y, z of each in turn). Calls `fail(message)`, which must
/// throw, if a coordinate is not finite.
template <class Fail>
std::vector<Point> finite_points(const std::vector<double>& coordinates, const Fail& fail) {
  std::vector<Point> points;
  points.reserve(coordinates.size() / 3);
  for (std::size_t i = 0; i + 2 < coordinates.size(); i += 3) {
    const Point p{coordinates[i], coordinates[i + 1], coordinates[i + 2]};
    if (!is_finite(p)) fail(fmt::format("point {}, ({}, {}, {}), is not finite", i / 3, p.x, p.y, p.z));
    points.push_back(p);
  }
  return points;
}

}  // namespace collarmesh::io
