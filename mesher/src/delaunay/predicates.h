#pragma once

#include <cmath>

#include "collarmesh/geometry.h"

/// Exact geometric decisions. Each is made in floating point when an error bound allows it and by CGAL's
/// exact arithmetic otherwise, so the result is always that of real arithmetic on the given doubles.
namespace collarmesh::predicates {

/// Returns the sign of six_volume(a, b, c, d), by exact arithmetic.
int orientation_exact(const Point& a, const Point& b, const Point& c, const Point& d);

/// Returns whether p is strictly inside the circumsphere of the positively oriented tetrahedron abcd. Exact.
bool in_sphere_exact(const Point& a, const Point& b, const Point& c, const Point& d, const Point& p);

/// Returns the circumcentre of a tetrahedron that is not flat, computed exactly, then rounded: each
/// coordinate is off by at most 6 times 2^-53 of itself.
Point circumcentre_exact(const Point& a, const Point& b, const Point& c, const Point& d);

/// Returns the sign of the first non-zero coordinate of (q - p) x (b - a), 0 if all vanish. Exact.
int cross_product_sign_exact(const Point& p, const Point& q, const Point& a, const Point& b);

/// Returns the sign of six_volume(a, b, c, d). The filter's bound is Shewchuk's (Adaptive precision
/// floating-point arithmetic, 1997, orient3d stage A).
inline int orientation(const Point& a, const Point& b, const Point& c, const Point& d) {
  const Vector u = b - a, v = c - a, w = d - a;
  const double yz = v.y * w.z, zy = v.z * w.y, zx = v.z * w.x, xz = v.x * w.z, xy = v.x * w.y, yx = v.y * w.x;
  const double det = u.x * (yz - zy) + u.y * (zx - xz) + u.z * (xy - yx);
  const double permanent = std::fabs(u.x) * (std::fabs(yz) + std::fabs(zy)) +
                           std::fabs(u.y) * (std::fabs(zx) + std::fabs(xz)) +
                           std::fabs(u.z) * (std::fabs(xy) + std::fabs(yx));
  constexpr double bound = 7.771561172376103e-16;  // (7 + 56 e) e with e = 2^-53
  if (det > bound * permanent) return 1;
  if (-det > bound * permanent) return -1;
  return orientation_exact(a, b, c, d);
}

}  // namespace collarmesh::predicates
