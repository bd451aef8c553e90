#pragma once

#include "collarmesh/geometry.h"

namespace collarmesh {

/// Returns the parameter, from 0 to 1, of the point of the segment ab nearest to p; 0 if the segment is a
/// point.
double parameter_on_segment(const Point& p, const Point& a, const Point& b);
/// Returns the point of the segment ab, which may be degenerate, that is nearest to p.
Point nearest_point_on_segment(const Point& p, const Point& a, const Point& b);
/// Returns the point of the triangle abc, which may be degenerate, that is nearest to p.
Point nearest_point_on_triangle(const Point& p, const Point& a, const Point& b, const Point& c);

inline double distance_to_segment(const Point& p, const Point& a, const Point& b) {
  return distance(p, nearest_point_on_segment(p, a, b));
}
double squared_distance_to_segment(const Point& p, const Point& a, const Point& b);
/// Returns the squared distance from p to the triangle abc, which may be degenerate.
double squared_distance_to_triangle(const Point& p, const Point& a, const Point& b, const Point& c);
/// Returns whether the squared distance from p to the triangle abc, which may be degenerate, is below the
/// bound.
bool is_within(double squared_bound, const Point& p, const Point& a, const Point& b, const Point& c);

/// Returns the squared distance from p to the box; 0 inside.
inline double squared_distance_to_box(const Point& p, const Box& box) {
  const auto beyond = [](double from, double at, double to) {
    const double below = from - at, above = at - to;
    const double d = below > above ? below : above;
    return d > 0 ? d : 0;
  };
  return squared_norm({beyond(box.min.x, p.x, box.max.x), beyond(box.min.y, p.y, box.max.y),
                       beyond(box.min.z, p.z, box.max.z)});
}

}  // namespace collarmesh
