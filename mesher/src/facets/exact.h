#pragma once

#include <array>

#include "collarmesh/geometry.h"

/// Exact decisions of the builder, apart from the orientation test of `delaunay/predicates.h`. The results
/// are those of real arithmetic on the given doubles.
namespace collarmesh::facets {

/// Returns the sign of the area of abc projected along `axis`: positive if abc is counterclockwise in the
/// plane of the coordinates axis + 1 and axis + 2.
int planar_orientation(unsigned axis, const Point& a, const Point& b, const Point& c);

/// Returns whether the three points lie on one line.
bool collinear(const Point& a, const Point& b, const Point& c);

/// Returns whether b lies between a and c, for three distinct points on one line.
bool between(const Point& a, const Point& b, const Point& c);

/// Returns whether c and d lie strictly on one side of the line ab. Precondition: all points are in one
/// plane, and a, b and c are not on one line.
bool same_side(const Point& a, const Point& b, const Point& c, const Point& d);

/// Returns the sign of r0 - r1, where the line from p to q crosses the plane of triangle ti at parameter ri.
/// Precondition: p and q lie strictly on different sides of both planes.
int compare_crossings(const Point& p, const Point& q, const std::array<Point, 3>& t0,
                      const std::array<Point, 3>& t1);

}  // namespace collarmesh::facets
