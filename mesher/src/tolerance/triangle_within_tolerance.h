#pragma once

#include "location/triangle_hierarchy.h"

namespace collarmesh {

/// Returns a triangle within the tolerance of p, among those that `counts` accepts: one nearer than `least`,
/// the `hint` if possible; else the nearest one, if its own tolerance allows its distance; else none. `at`
/// returns the tolerance of a triangle, from `least` to `most`. Precondition: `counts` accepts the hint, if
/// there is one.
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
