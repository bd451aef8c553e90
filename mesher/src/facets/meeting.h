#pragma once

#include "collarmesh/geometry.h"

/// Decides exactly whether two simplices, as closed sets, meet. All corners are distinct points; triangles
/// have an area.
namespace collarmesh::facets {

bool point_on_segment(const Point& p, const Point& a, const Point& b);
bool point_on_triangle(const Point& p, const Point& a, const Point& b, const Point& c);
bool segments_meet(const Point& a, const Point& b, const Point& c, const Point& d);
bool segment_meets_triangle(const Point& p, const Point& q, const Point& a, const Point& b, const Point& c);

}  // namespace collarmesh::facets
