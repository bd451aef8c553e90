// Features of the complex that lie outside all regions: the mesh does not have them.
#include <algorithm>
#include <cmath>

#include "check/subject.h"

namespace collarmesh::checks {

namespace {

struct Hit {
  double along = INFINITY;  // the ray's parameter
  Index triangle = none;
  bool from_behind = false;
  bool doubtful = false;  // some triangle was met close to its border
};

// Moeller and Trumbore, Fast minimum storage ray-triangle intersection, 1997.
Hit first_hit(const Plc& plc, const Point& p, const Vector& direction) {
  constexpr double margin = 1e-9;
  Hit hit;
  for (Index i = 0; i < plc.triangles.size(); ++i) {
    const auto& corners = plc.triangles[i].points;
    const Point& a = plc.points[corners[0]];
    const Vector ab = plc.points[corners[1]] - a, ac = plc.points[corners[2]] - a, ap = p - a;
    const Vector h = cross(direction, ac), q = cross(ap, ab);
    const double determinant = dot(ab, h), scale = norm(direction) * norm(ab) * norm(ac);
    if (std::fabs(determinant) <= margin * scale) {
      // Seen edge on: doubtful only if the ray comes near the triangle at all, which other
      // directions decide better; without a hit it does not count.
      continue;
    }
    const double u = dot(ap, h) / determinant, v = dot(direction, q) / determinant,
                 t = dot(ac, q) / determinant;
    if (u < -margin || v < -margin || u + v > 1 + margin || t < 0) continue;
    if (u < margin || v < margin || u + v > 1 - margin) hit.doubtful = true;
    if (t < hit.along) {
      hit.along = t;
      hit.triangle = i;
      hit.from_behind = determinant < 0;
    }
  }
  return hit;
}

}  // namespace

Index region_at(const Plc& plc, const Point& p) {
  Hit hit;
  for (const Vector& direction : {Vector{0.5377, 0.8339, 0.1283}, Vector{-0.2588, 0.8622, -0.4336},
                                  Vector{0.3426, -0.5784, 0.7694}, Vector{-0.7254, -0.0631, 0.7147}}) {
    hit = first_hit(plc, p, direction);
    if (!hit.doubtful) break;
  }
  if (hit.triangle == none) return 0;
  return plc.patches[plc.triangles[hit.triangle].patch].regions[hit.from_behind ? 0 : 1];
}

bool patch_is_outside(const Plc& plc, Index patch) {
  return plc.patches[patch].regions[0] == 0 && plc.patches[patch].regions[1] == 0;
}

bool curve_is_outside(const Plc& plc, Index curve) {
  const Plc::Curve& c = plc.curves[curve];
  if (!c.patches.empty())
    return std::all_of(c.patches.begin(), c.patches.end(), [&](Index p) { return patch_is_outside(plc, p); });
  const std::size_t i = c.points.size() / 2;
  return region_at(plc, 0.5 * (plc.points[c.points[i - 1]] + plc.points[c.points[i]])) == 0;
}

bool vertex_is_outside(const Plc& plc, Index vertex) {
  const Plc::Vertex& v = plc.vertices[vertex];
  if (v.patches.empty() && v.curves.empty()) return region_at(plc, plc.points[v.point]) == 0;
  return std::all_of(v.patches.begin(), v.patches.end(), [&](Index p) { return patch_is_outside(plc, p); }) &&
         std::all_of(v.curves.begin(), v.curves.end(), [&](Index c) { return curve_is_outside(plc, c); });
}

}  // namespace collarmesh::checks
