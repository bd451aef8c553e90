#pragma once

#include <array>

#include "collarmesh/geometry.h"

/// Exact decisions of the builder beside the orientation test of `delaunay/predicates.h`. All are
/// those of real arithmetic on the given doubles.
namespace collarmesh::facets {

/// Sign of the signed area of abc seen against `axis`: positive when they turn counterclockwise in
/// the plane of the coordinates axis + 1 and axis + 2.
int planar_orientation(unsigned axis, const Point& a, const Point& b, const Point& c);

/// Do the three points lie on one line?
bool collinear(const Point& a, const Point& b, const Point& c);

/// Returns whether b lies between a and c, for three distinct points on one line.
bool between(const Point& a, const Point& b, const Point& c);

/// Returns whether c and d lie strictly on one side of the line ab, for points in a plane, abc not on a line.
bool same_side(const Point& a, const Point& b, const Point& c, const Point& d);

/// Sign of t0 - t1, where the line from p to q crosses the plane of the triangle ti at the
/// parameter ti. Precondition: p and q lie strictly on different sides of both planes.
int compare_crossings(const Point& p, const Point& q, const std::array<Point, 3>& t0,
                      const std::array<Point, 3>& t1);

}  // namespace collarmesh::facets
