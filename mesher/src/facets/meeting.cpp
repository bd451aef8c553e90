#include "facets/meeting.h"

#include <algorithm>

#include "delaunay/predicates.h"
#include "facets/exact.h"

namespace collarmesh::facets {

namespace {

using predicates::orientation;

// Returns a coordinate whose removal projects abc to a triangle; 3 if the points are collinear.
unsigned projection_axis(const Point& a, const Point& b, const Point& c) {
  unsigned axis = 0;
  while (axis < 3 && planar_orientation(axis, a, b, c) == 0) ++axis;
  return axis;
}

bool in_triangle(unsigned axis, const Point& p, const Point& a, const Point& b, const Point& c) {
  const auto [low, high] = std::minmax({planar_orientation(axis, a, b, p), planar_orientation(axis, b, c, p),
                                        planar_orientation(axis, c, a, p)});
  return low >= 0 || high <= 0;
}

bool coplanar_segments_meet(unsigned axis, const Point& a, const Point& b, const Point& c, const Point& d) {
  const int ca = planar_orientation(axis, c, d, a), cb = planar_orientation(axis, c, d, b);
  const int ac = planar_orientation(axis, a, b, c), ad = planar_orientation(axis, a, b, d);
  if (ca * cb < 0 && ac * ad < 0) return true;
  return (ac == 0 && between(a, c, b)) || (ad == 0 && between(a, d, b)) || (ca == 0 && between(c, a, d)) ||
         (cb == 0 && between(c, b, d));
}

}  // namespace

bool point_on_segment(const Point& p, const Point& a, const Point& b) {
  return collinear(a, b, p) && between(a, p, b);
}

bool point_on_triangle(const Point& p, const Point& a, const Point& b, const Point& c) {
  return orientation(a, b, c, p) == 0 && in_triangle(projection_axis(a, b, c), p, a, b, c);
}

bool segments_meet(const Point& a, const Point& b, const Point& c, const Point& d) {
  if (orientation(a, b, c, d) != 0) return false;
  unsigned axis = projection_axis(a, b, c);
  if (axis == 3) axis = projection_axis(a, b, d);
  if (axis == 3) return between(a, c, b) || between(a, d, b) || between(c, a, d);
  return coplanar_segments_meet(axis, a, b, c, d);
}

bool segment_meets_triangle(const Point& p, const Point& q, const Point& a, const Point& b, const Point& c) {
  const int from = orientation(a, b, c, p), to = orientation(a, b, c, q);
  if (from * to > 0) return false;
  if (from == 0 && to == 0) {
    const unsigned axis = projection_axis(a, b, c);
    return in_triangle(axis, p, a, b, c) || in_triangle(axis, q, a, b, c) ||
           coplanar_segments_meet(axis, p, q, a, b) || coplanar_segments_meet(axis, p, q, b, c) ||
           coplanar_segments_meet(axis, p, q, c, a);
  }
  const auto [low, high] =
      std::minmax({orientation(p, q, a, b), orientation(p, q, b, c), orientation(p, q, c, a)});
  return low >= 0 || high <= 0;
}

}  // namespace collarmesh::facets
