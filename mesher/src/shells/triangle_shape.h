#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "collarmesh/geometry.h"

namespace collarmesh::shells {

using Corners = std::array<Point, 3>;

/// The lower bound on the angles of triangles, and the quality (`shape_of`) that improvement aims at; both in
/// degrees.
inline constexpr double least_angle = 20, wanted_shape = 28;

inline Vector area_vector(const Corners& t) { return 0.5 * cross(t[1] - t[0], t[2] - t[0]); }

/// Returns the angle between the vector (x, y), y >= 0, and the x axis, in degrees, with an error below
/// 0.001. Avoids `std::atan2`, which would take most of the time of `shape_of`.
inline double angle_of(double x, double y) {
  const double u = std::fabs(x), z = u > y ? y / u : u / std::max(y, 1e-300), w = z * z;
  constexpr double degrees = 180 / std::numbers::pi;
  const double angle =
      degrees * z * (0.9998660 + w * (-0.3302995 + w * (0.1801410 + w * (-0.0851330 + w * 0.0208351))));
  const double steep = u > y ? angle : 90 - angle;
  return x < 0 ? 180 - steep : steep;
}

/// Returns the quality of a triangle: the smaller of its smallest angle and a third of the difference between
/// 180 degrees and its largest angle. It is 20 if an angle is at its bound (20 or 120), 40 in an equilateral
/// triangle, 0 in a flat one.
inline double shape_of(const Corners& t) {
  double a = squared_distance(t[1], t[2]), b = squared_distance(t[2], t[0]), c = squared_distance(t[0], t[1]);
  if (a > b) std::swap(a, b);
  if (b > c) std::swap(b, c);
  if (a > b) std::swap(a, b);
  const double four_areas = 2 * norm(cross(t[1] - t[0], t[2] - t[0]));
  if (!(four_areas > 0)) return 0;
  return std::min(angle_of(b + c - a, four_areas), (180 - angle_of(a + b - c, four_areas)) / 3);
}

inline Point circumcentre(const Corners& t) {
  const Vector u = t[1] - t[0], v = t[2] - t[0], n = cross(u, v);
  const double scale = 2 * squared_norm(n);
  if (!(scale > 0)) return (t[0] + t[1] + t[2]) / 3;
  return t[0] + cross(squared_norm(u) * v - squared_norm(v) * u, n) / scale;
}

/// Returns the barycentric coordinates of p's projection onto the plane of the triangle.
inline std::array<double, 3> barycentric(const Corners& t, const Point& p) {
  const Vector n = cross(t[1] - t[0], t[2] - t[0]);
  const double all = squared_norm(n);
  if (!(all > 0)) return {1, 0, 0};
  const double b = dot(cross(p - t[0], t[2] - t[0]), n) / all, c = dot(cross(t[1] - t[0], p - t[0]), n) / all;
  return {1 - b - c, b, c};
}

}  // namespace collarmesh::shells
