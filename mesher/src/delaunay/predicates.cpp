#include "delaunay/predicates.h"

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

namespace collarmesh::predicates {

namespace {

using Filtered = CGAL::Exact_predicates_inexact_constructions_kernel;
using Exact = CGAL::Exact_predicates_exact_constructions_kernel::Exact_kernel;

Filtered::Point_3 filtered(const Point& p) { return {p.x, p.y, p.z}; }
Exact::Point_3 exact(const Point& p) { return {p.x, p.y, p.z}; }

}  // namespace

int orientation_exact(const Point& a, const Point& b, const Point& c, const Point& d) {
  return static_cast<int>(CGAL::orientation(filtered(a), filtered(b), filtered(c), filtered(d)));
}

bool in_sphere_exact(const Point& a, const Point& b, const Point& c, const Point& d, const Point& p) {
  return CGAL::side_of_oriented_sphere(filtered(a), filtered(b), filtered(c), filtered(d), filtered(p)) ==
         CGAL::ON_POSITIVE_SIDE;
}

Point circumcentre_exact(const Point& a, const Point& b, const Point& c, const Point& d) {
  const Exact::Point_3 centre = CGAL::circumcenter(exact(a), exact(b), exact(c), exact(d));
  return {CGAL::to_double(centre.x()), CGAL::to_double(centre.y()), CGAL::to_double(centre.z())};
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
