#pragma once

#include "location/triangle_hierarchy.h"

namespace collarmesh {

/// Returns a triangle whose distance from p is within the tolerance there: the `hint`, if it is such a
/// triangle; else any triangle within the `least` tolerance; else the nearest one; none if there is no such
/// triangle. `at` returns the tolerance of a triangle, from `least` to `most`; `counts` returns whether a
/// triangle counts, the hint included.
template <class At, class Counts>
Index triangle_within_tolerance(const TriangleHierarchy& triangles, const Point& p, double least, double most,
                                const At& at, Index hint, const Counts& counts) {
  const Index close = triangles.triangle_within(p, least * least, hint, counts);
  if (close != none || least == most) return close;
  Index nearest = none;
  const double squared = triangles.squared_distance_to(p, most * most, &nearest, counts);
  return nearest != none && squared < at(nearest) * at(nearest) ? nearest : none;
}

}  // namespace collarmesh
