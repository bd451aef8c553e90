#include "common/distances.h"

#include <algorithm>

namespace collarmesh {

namespace {

// Square of the ratio of height to longest side below which a triangle is a needle.
constexpr double squared_needle = 1e-12;

}  // namespace

double parameter_on_segment(const Point& p, const Point& a, const Point& b) {
  const Vector d = b - a;
  const double length = squared_norm(d);
  return length > 0 ? std::clamp(dot(p - a, d) / length, 0.0, 1.0) : 0.0;
}

Point nearest_point_on_segment(const Point& p, const Point& a, const Point& b) {
  return a + parameter_on_segment(p, a, b) * (b - a);
}

Point nearest_point_on_triangle(const Point& p, const Point& a, const Point& b, const Point& c) {
  const Vector u = b - a, w = c - a, n = cross(u, w);
  const double nn = squared_norm(n), longest = std::max(squared_norm(u), squared_norm(w));
  const bool inside = nn > 0 && dot(cross(u, p - a), n) >= 0 && dot(cross(c - b, p - b), n) >= 0 &&
                      dot(cross(a - c, p - c), n) >= 0;
  const Point foot = inside ? p - (dot(p - a, n) / nn) * n : p;
  if (inside && nn > squared_needle * longest * longest) return foot;
  Point best = nearest_point_on_segment(p, a, b);
  for (const Point& q : {nearest_point_on_segment(p, b, c), nearest_point_on_segment(p, c, a)})
    if (squared_distance(p, q) < squared_distance(p, best)) best = q;
  // The normal of a needle is inaccurate, so the distance to its border bounds the result from above.
  return inside && squared_distance(p, foot) < squared_distance(p, best) ? foot : best;
}

double squared_distance_to_triangle(const Point& p, const Point& a, const Point& b, const Point& c) {
  return squared_distance(p, nearest_point_on_triangle(p, a, b, c));
}

double squared_distance_to_segment(const Point& p, const Point& a, const Point& b) {
  return squared_distance(p, nearest_point_on_segment(p, a, b));
}

// First tests the distance from the plane, which decides for most points, and whether the point projects into
// the triangle. If it does not, the nearest point of the triangle lies on a side that has p beyond it.
bool is_within(double squared_bound, const Point& p, const Point& a, const Point& b, const Point& c) {
  const Vector u = b - a, w = c - a, n = cross(u, w);
  const double nn = squared_norm(n), longest = std::max(squared_norm(u), squared_norm(w));
  if (!(nn > squared_needle * longest * longest))
    return squared_distance_to_triangle(p, a, b, c) < squared_bound;
  const double height = dot(p - a, n);
  if (height * height >= squared_bound * nn) return false;
  bool inside = true;
  const auto is_near_side = [&](const Point& from, const Point& to) {
    if (dot(cross(to - from, p - from), n) >= 0) return false;
    inside = false;
    return squared_distance_to_segment(p, from, to) < squared_bound;
  };
  return is_near_side(a, b) || is_near_side(b, c) || is_near_side(c, a) || inside;
}

}  // namespace collarmesh
