#include "mesh/orientation.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

namespace collarmesh {

int exact_orientation(const Point& a, const Point& b, const Point& c, const Point& d) {
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  const auto exact = [](const Point& p) { return Kernel::Point_3(p.x, p.y, p.z); };
  return static_cast<int>(CGAL::orientation(exact(a), exact(b), exact(c), exact(d)));
}

}  // namespace collarmesh
