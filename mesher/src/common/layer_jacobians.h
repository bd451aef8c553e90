#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "collarmesh/geometry.h"

/// Jacobian determinants of prisms and pyramids, whose corners are in the order of LayerCells.
namespace collarmesh {

using PrismCorners = std::array<Point, 6>;
using PyramidCorners = std::array<Point, 5>;

/// Returns the Jacobian along the edge of a linear prism that rises from a corner of its base triangle: a
/// quadratic polynomial in Bernstein form. Between these edges the Jacobian is linear.
inline std::array<double, 3> jacobian_along_edge(const PrismCorners& p, unsigned corner) {
  const unsigned a = corner, b = (corner + 1) % 3, c = (corner + 2) % 3;
  const Vector u = p[b] - p[a], v = p[c] - p[a], u_above = p[b + 3] - p[a + 3], v_above = p[c + 3] - p[a + 3],
               rise = p[a + 3] - p[a];
  return {dot(cross(u, v), rise), 0.5 * (dot(cross(u, v_above), rise) + dot(cross(u_above, v), rise)),
          dot(cross(u_above, v_above), rise)};
}

/// Returns a lower bound of the polynomial of `jacobian_along_edge` on the whole edge; it is positive exactly
/// if the polynomial is.
inline double least_along_edge(const std::array<double, 3>& b) {
  const double ends = std::min(b[0], b[2]);
  if (b[1] >= ends || !(ends > 0)) return std::min(ends, b[1]);
  const double bend = b[0] - 2 * b[1] + b[2];
  return (b[0] * b[2] - b[1] * b[1]) / bend;
}

/// Returns the least Jacobian of a linear prism over all of its points or, if that is not positive, a lower
/// bound that is not positive either. If the Jacobian is constant, it is twice the volume.
inline double least_jacobian(const PrismCorners& p) {
  double least = INFINITY;
  for (unsigned corner = 0; corner < 3; ++corner)
    least = std::min(least, least_along_edge(jacobian_along_edge(p, corner)));
  return least;
}

/// Returns the volume of a linear prism, whose sides are bilinear surfaces.
inline double volume_of(const PrismCorners& p) {
  double sum = 0;
  for (unsigned corner = 0; corner < 3; ++corner)
    for (const double b : jacobian_along_edge(p, corner)) sum += b;
  return sum / 18;
}

/// Returns the Jacobians of a linear pyramid at the corners of its base. The smallest of them is the least
/// Jacobian of the pyramid. If they are equal, each is three times the volume.
inline std::array<double, 4> jacobians_at_base(const PyramidCorners& p) {
  std::array<double, 4> found{};
  for (unsigned i = 0; i < 4; ++i) found[i] = six_volume(p[i], p[(i + 1) % 4], p[(i + 3) % 4], p[4]);
  return found;
}

inline double least_jacobian(const PyramidCorners& p) {
  const auto all = jacobians_at_base(p);
  return *std::ranges::min_element(all);
}

/// Returns the volume of a linear pyramid, whose base is a bilinear surface.
inline double volume_of(const PyramidCorners& p) {
  double sum = 0;
  for (const double j : jacobians_at_base(p)) sum += j;
  return sum / 12;
}

/// Returns the least Jacobian of a prism of second order at its corners, at the middles of its edges that
/// rise, and at the integration points of degree five. `mid` has the order of LayerCells.
double least_jacobian_at_points(const PrismCorners& corners, const std::array<Point, 9>& mid);
/// Returns the least Jacobian of a pyramid of second order at the same kinds of points, except its apex.
double least_jacobian_at_points(const PyramidCorners& corners, const std::array<Point, 8>& mid);

}  // namespace collarmesh
