#include "delaunay/predicates.h"

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/MP_Float.h>
#include <CGAL/Mpzf.h>
#include <CGAL/Simple_cartesian.h>

namespace collarmesh::predicates {

namespace {

using Filtered = CGAL::Exact_predicates_inexact_constructions_kernel;
using Exact = CGAL::Exact_predicates_exact_constructions_kernel::Exact_kernel;

Filtered::Point_3 filtered(const Point& p) { return {p.x, p.y, p.z}; }
Exact::Point_3 exact(const Point& p) { return {p.x, p.y, p.z}; }

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
  const Exact::Vector_3 product = CGAL::cross_product(exact(q) - exact(p), exact(b) - exact(a));
  for (int axis = 0; axis < 3; ++axis) {
    const auto sign = CGAL::sign(product[axis]);
    if (sign != CGAL::ZERO) return static_cast<int>(sign);
  }
  return 0;
}

}  // namespace collarmesh::predicates
