#include "facets/exact.h"

#include <cassert>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Exact_rational.h>

namespace collarmesh::facets {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Rational = CGAL::Exact_rational;

Kernel::Point_3 to_cgal(const Point& p) { return {p.x, p.y, p.z}; }

std::array<Rational, 3> difference(const Point& a, const Point& b) {
  return {Rational(a.x) - Rational(b.x), Rational(a.y) - Rational(b.y), Rational(a.z) - Rational(b.z)};
}

Rational exact_six_volume(const std::array<Point, 3>& t, const Point& d) {
  const auto u = difference(t[1], t[0]), v = difference(t[2], t[0]), w = difference(d, t[0]);
  return w[0] * (u[1] * v[2] - u[2] * v[1]) + w[1] * (u[2] * v[0] - u[0] * v[2]) +
         w[2] * (u[0] * v[1] - u[1] * v[0]);
}

}  // namespace

int planar_orientation(unsigned axis, const Point& a, const Point& b, const Point& c) {
  const unsigned i = (axis + 1) % 3, j = (axis + 2) % 3;
  return static_cast<int>(CGAL::orientation(Kernel::Point_2(a[i], a[j]), Kernel::Point_2(b[i], b[j]),
                                            Kernel::Point_2(c[i], c[j])));
}

bool collinear(const Point& a, const Point& b, const Point& c) {
  // Most triples are far from collinear; a bound on the rounding errors of the cross product proves that.
  const Vector u = b - a, v = c - a;
  const double bound = 1e-14 * norm(u) * norm(v);
  if (squared_norm(cross(u, v)) > bound * bound) return false;
  return CGAL::collinear(to_cgal(a), to_cgal(b), to_cgal(c));
}

bool between(const Point& a, const Point& b, const Point& c) {
  return CGAL::collinear_are_strictly_ordered_along_line(to_cgal(a), to_cgal(b), to_cgal(c));
}

bool same_side(const Point& a, const Point& b, const Point& c, const Point& d) {
  assert(!collinear(a, b, c));
  for (unsigned axis = 0; axis < 3; ++axis) {
    const int side = planar_orientation(axis, a, b, c);
    if (side != 0) return planar_orientation(axis, a, b, d) == side;
  }
  return false;
}

int compare_crossings(const Point& p, const Point& q, const std::array<Point, 3>& t0,
                      const std::array<Point, 3>& t1) {
  // The parameter ri is P / (P - Q); P and Q are the signed volumes of the tets that triangle ti spans with p
  // and q.
  const Rational p0 = exact_six_volume(t0, p), q0 = exact_six_volume(t0, q);
  const Rational p1 = exact_six_volume(t1, p), q1 = exact_six_volume(t1, q);
  assert(p0 * q0 < 0 && p1 * q1 < 0);
  const Rational r0 = p0 / (p0 - q0), r1 = p1 / (p1 - q1);
  return r0 < r1 ? -1 : r0 > r1 ? 1 : 0;
}

}  // namespace collarmesh::facets
