#include "support/brute_force_gap.h"

#include <algorithm>
#include <cmath>

namespace collarmesh::testing {

double distance_to_segment(const Point& p, const Point& a, const Point& b) {
  const Vector d = b - a;
  const double t = std::clamp(dot(p - a, d) / squared_norm(d), 0.0, 1.0);
  return distance(p, a + t * d);
}

namespace {

double to_triangle(const Point& p, const Point& a, const Point& b, const Point& c) {
  const Vector n = cross(b - a, c - a);
  const Point foot = p - (dot(p - a, n) / squared_norm(n)) * n;
  const auto left_of = [&](const Point& u, const Point& v) { return dot(cross(v - u, foot - u), n) >= 0; };
  if (left_of(a, b) && left_of(b, c) && left_of(c, a)) return distance(p, foot);
  return std::min({distance_to_segment(p, a, b), distance_to_segment(p, b, c), distance_to_segment(p, c, a)});
}

}  // namespace

bool Containing::has_curve(Index c) const {
  return std::find(curves.begin(), curves.end(), c) != curves.end();
}
bool Containing::has_patch(Index p) const {
  return std::find(patches.begin(), patches.end(), p) != patches.end();
}

Containing features_of_vertex(const Plc& plc, Index v) {
  Containing features{v, {}, {}};
  const Index point = plc.vertices[v].point;
  for (Index c = 0; c < plc.curves.size(); ++c)
    if (std::count(plc.curves[c].points.begin(), plc.curves[c].points.end(), point) > 0)
      features.curves.push_back(c);
  features.patches = plc.vertices[v].patches;
  for (const auto& t : plc.triangles)
    if (std::count(t.points.begin(), t.points.end(), point) > 0 && !features.has_patch(t.patch))
      features.patches.push_back(t.patch);
  return features;
}

double brute_force_gap(const Plc& plc, const Point& p, const Containing& features) {
  double gap = INFINITY;
  for (Index v = 0; v < plc.vertices.size(); ++v)
    if (v != features.vertex) gap = std::min(gap, distance(p, plc.points[plc.vertices[v].point]));
  for (Index c = 0; c < plc.curves.size(); ++c) {
    if (features.has_curve(c)) continue;
    const auto& points = plc.curves[c].points;
    for (std::size_t i = 0; i + 1 < points.size() + (plc.curves[c].closed ? 1 : 0); ++i)
      gap = std::min(
          gap, distance_to_segment(p, plc.points[points[i]], plc.points[points[(i + 1) % points.size()]]));
  }
  for (const auto& t : plc.triangles)
    if (!features.has_patch(t.patch))
      gap = std::min(
          gap, to_triangle(p, plc.points[t.points[0]], plc.points[t.points[1]], plc.points[t.points[2]]));
  return gap;
}

std::vector<Point> points_along(const Plc& plc, Index curve, unsigned per_segment) {
  const Plc::Curve& c = plc.curves[curve];
  std::vector<Point> samples;
  for (std::size_t i = 0; i + 1 < c.points.size() + (c.closed ? 1 : 0); ++i) {
    const Point &a = plc.points[c.points[i]], &b = plc.points[c.points[(i + 1) % c.points.size()]];
    for (unsigned k = 1; k <= per_segment; ++k)
      samples.push_back(a + double(k) / (per_segment + 1) * (b - a));
  }
  return samples;
}

}  // namespace collarmesh::testing
