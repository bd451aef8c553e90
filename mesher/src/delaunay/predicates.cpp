#include "delaunay/predicates.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/MP_Float.h>
#include <CGAL/Mpzf.h>
#include <CGAL/Simple_cartesian.h>

#include <array>
#include <cmath>

namespace collarmesh::predicates {

namespace {

using Filtered = CGAL::Exact_predicates_inexact_constructions_kernel;

Filtered::Point_3 filtered(const Point& p) { return {p.x, p.y, p.z}; }

// Exact sums and products of doubles, far faster than rational numbers.
#ifdef CGAL_HAS_MPZF
using Ring = CGAL::Mpzf;
#else
using Ring = CGAL::MP_Float;
#endif
using RingVector = CGAL::Simple_cartesian<Ring>::Vector_3;

RingVector ring_vector(const Point& p) { return {Ring(p.x), Ring(p.y), Ring(p.z)}; }

}  // namespace

int orientation_exact(const Point& a, const Point& b, const Point& c, const Point& d) {
  return static_cast<int>(CGAL::orientation(filtered(a), filtered(b), filtered(c), filtered(d)));
}

bool in_sphere_exact(const Point& a, const Point& b, const Point& c, const Point& d, const Point& p) {
  return CGAL::side_of_oriented_sphere(filtered(a), filtered(b), filtered(c), filtered(d), filtered(p)) ==
         CGAL::ON_POSITIVE_SIDE;
}

Point circumcentre_exact(const Point& a, const Point& b, const Point& c, const Point& d) {
  const RingVector origin = ring_vector(a);
  const RingVector u = ring_vector(b) - origin, v = ring_vector(c) - origin, w = ring_vector(d) - origin;
  const RingVector vw = CGAL::cross_product(v, w);
  const Ring divisor = Ring(2) * (u * vw);
  const RingVector dividend = (w * w) * CGAL::cross_product(u, v) + (v * v) * CGAL::cross_product(w, u) +
                              (u * u) * vw + divisor * origin;
  const auto quotient = [&](const Ring& x) { return CGAL::to_double(x) / CGAL::to_double(divisor); };
  return {quotient(dividend.x()), quotient(dividend.y()), quotient(dividend.z())};
}

int cross_product_sign_exact(const Point& p, const Point& q, const Point& a, const Point& b) {
  // Each product of rounded differences is off by at most three roundings, and the difference of two products
  // by one more. Below the smallest sum, products may lose bits to underflow.
  constexpr double roundings = 1e-15, smallest_sum = 1e-280;
  const Vector u = q - p, v = b - a;
  const std::array<double, 3> us{u.x, u.y, u.z}, vs{v.x, v.y, v.z};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t j = (axis + 1) % 3, k = (axis + 2) % 3;
    if ((us[j] == 0 || vs[k] == 0) && (us[k] == 0 || vs[j] == 0)) continue;
    const double left = us[j] * vs[k], right = us[k] * vs[j], sum = std::fabs(left) + std::fabs(right);
    if (sum > smallest_sum && std::fabs(left - right) > roundings * sum) return left > right ? 1 : -1;
    const std::array<std::array<double, 3>, 4> points{
        {{p.x, p.y, p.z}, {q.x, q.y, q.z}, {a.x, a.y, a.z}, {b.x, b.y, b.z}}};
    const auto along = [&](std::size_t from, std::size_t to, std::size_t i) {
      return Ring(points[to][i]) - Ring(points[from][i]);
    };
    const auto sign = CGAL::sign(along(0, 1, j) * along(2, 3, k) - along(0, 1, k) * along(2, 3, j));
    if (sign != CGAL::ZERO) return static_cast<int>(sign);
  }
  return 0;
}

}  // namespace collarmesh::predicates
