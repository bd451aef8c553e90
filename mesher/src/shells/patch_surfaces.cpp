#include "shells/patch_surfaces.h"

#include <algorithm>
#include <unordered_map>
#include <utility>

#include "common/distance_tree.h"
#include "common/distances.h"

namespace collarmesh::shells {

namespace {

Vector unit(const Vector& v) {
  const double length = norm(v);
  return length > 0 ? v / length : Vector{};
}

}  // namespace

PatchSurfaces::PatchSurfaces(const Plc& plc, SurfaceTolerance tolerance)
    : plc_(plc),
      tolerance_(std::move(tolerance)),
      normals_(plc.patches.size()),
      at_corners_(plc.triangles.size()),
      hierarchies_(plc.patches.size()),
      last_found_(plc.patches.size(), 0),
      least_tolerance_(plc.patches.size(), INFINITY) {
  for (Index patch = 0; patch < plc.patches.size(); ++patch) find_normals(patch);
  for (Index t = 0; t < plc.triangles.size(); ++t) {
    double& least = least_tolerance_[plc.triangles[t].patch];
    least = std::min(least, tolerance_.at_triangle(t));
  }
}

// Finds the patch's normals, weighted by areas, so that slivers of a tessellation do not matter.
void PatchSurfaces::find_normals(Index patch) {
  const Plc::Patch& p = plc_.patches[patch];
  std::unordered_map<Index, Vector> sums;
  for (Index t = p.first_triangle; t < p.first_triangle + p.triangle_count; ++t) {
    const auto& [a, b, c] = plc_.triangles[t].points;
    const Vector area = area_vector({plc_.points[a], plc_.points[b], plc_.points[c]});
    normals_[patch] = normals_[patch] + area;
    if (p.planar) continue;
    for (const Index point : {a, b, c}) sums[point] = sums[point] + area;
  }
  normals_[patch] = unit(normals_[patch]);
  if (p.planar) return;
  for (Index t = p.first_triangle; t < p.first_triangle + p.triangle_count; ++t)
    for (unsigned i = 0; i < 3; ++i) at_corners_[t][i] = unit(sums[plc_.triangles[t].points[i]]);
}

const TriangleHierarchy& PatchSurfaces::hierarchy(Index patch) const {
  if (!hierarchies_[patch]) hierarchies_[patch] = hierarchy_of_patch(plc_, patch);
  return *hierarchies_[patch];
}

Vector PatchSurfaces::normal_at(Index patch, Index triangle, const Point& p) const {
  if (planar(patch)) return normals_[patch];
  const auto& [a, b, c] = plc_.triangles[triangle].points;
  const Corners corners{plc_.points[a], plc_.points[b], plc_.points[c]};
  const auto shares = barycentric(corners, p);
  Vector sum{};
  for (unsigned i = 0; i < 3; ++i) sum = sum + std::clamp(shares[i], 0.0, 1.0) * at_corners_[triangle][i];
  if (squared_norm(sum) > 1e-6) return unit(sum);
  const Vector own = area_vector(corners);
  return squared_norm(own) > 0 ? unit(own) : normals_[patch];
}

/// Returns the triangle nearest to p, or any triangle that is nearer than the share `enough` of the patch's
/// least tolerance.
Index PatchSurfaces::triangle_near(Index patch, const Point& p, double enough) const {
  const TriangleHierarchy& tree = hierarchy(patch);
  const Index first = plc_.patches[patch].first_triangle;
  Index& found = last_found_[patch];
  const auto squared_distance_to = [&](Index triangle) {
    const auto c = tree.corners(triangle);
    return squared_distance_to_triangle(p, c[0], c[1], c[2]);
  };
  const double most = enough * least_tolerance_[patch], squared_enough = most * most;
  double bound = squared_distance_to(found);
  if (bound <= squared_enough) return first + found;
  const Index root = tree.root();
  tree.visit_near({&root, 1}, p, bound, [&](Index triangle) {
    const double squared = squared_distance_to(triangle);
    if (squared >= bound) return;
    found = triangle;
    bound = squared <= squared_enough ? 0 : squared;
  });
  return first + found;
}

PatchSurfaces::Foot PatchSurfaces::foot_on(Index patch, Index triangle, const Point& p) const {
  const auto& [a, b, c] = plc_.triangles[triangle].points;
  const Point foot = nearest_point_on_triangle(p, plc_.points[a], plc_.points[b], plc_.points[c]);
  return {foot, normal_at(patch, triangle, foot), triangle, distance(p, foot),
          tolerance_.at_triangle(triangle)};
}

PatchSurfaces::Foot PatchSurfaces::nearest(Index patch, const Point& p) const {
  return foot_on(patch, triangle_near(patch, p, 0), p);
}

double PatchSurfaces::agreement(const Corners& t, Index patch) const { return fit(t, patch).agreement; }

PatchSurfaces::Fit PatchSurfaces::fit(const Corners& t, Index patch, double enough) const {
  constexpr double certain = 0.8;  // above this agreement, a place near enough is taken for the nearest one
  const Vector area = area_vector(t);
  const double size = norm(area);
  const auto agreement = [&](const Vector& normal) { return size > 0 ? dot(area, normal) / size : -1; };
  if (planar(patch)) return {agreement(normals_[patch]), 0};
  const Point centre = (t[0] + t[1] + t[2]) / 3;
  const Foot near = foot_on(patch, triangle_near(patch, centre, enough), centre);
  const Fit fit{agreement(near.normal), near.distance / near.tolerance};
  if (!(enough > 0) || fit.agreement > certain || !(size > 0)) return fit;
  const Foot nearest_one = nearest(patch, centre);
  return {agreement(nearest_one.normal), nearest_one.distance / nearest_one.tolerance};
}

double PatchSurfaces::excess_between(Index patch, const Point& a, const Point& b, double enough) const {
  if (planar(patch)) return 0;
  double most = 0;
  for (const double share : {1.0 / 3, 2.0 / 3}) {
    const Point p = a + share * (b - a);
    const Index t = triangle_near(patch, p, enough);
    const auto& [i, j, k] = plc_.triangles[t].points;
    const double squared = squared_distance_to_triangle(p, plc_.points[i], plc_.points[j], plc_.points[k]);
    most = std::max(most, std::sqrt(squared) / tolerance_.at_triangle(t));
  }
  return most;
}

std::vector<std::pair<Index, Point>> PatchSurfaces::far_points(Index patch,
                                                               std::span<const Corners> triangles,
                                                               double share) const {
  std::vector<std::pair<Index, Point>> found;
  if (planar(patch) || triangles.empty()) return found;
  const DistanceTree tree({triangles.begin(), triangles.end()});
  const Plc::Patch& p = plc_.patches[patch];
  std::vector<bool> taken(triangles.size(), false);
  Index hint = none;
  const auto look_at = [&](const Point& place, double tolerance) {
    const auto nearest = tree.nearest(place, share * tolerance, hint);
    hint = nearest.triangle;
    if (nearest.distance <= share * tolerance || taken[hint]) return;
    taken[hint] = true;
    found.emplace_back(hint, place);
  };
  for (Index t = p.first_triangle; t < p.first_triangle + p.triangle_count; ++t) {
    Point centre{};
    for (const Index point : plc_.triangles[t].points) {
      look_at(plc_.points[point], tolerance_.at_point(point));
      centre = centre + plc_.points[point] / 3;
    }
    look_at(centre, tolerance_.at_triangle(t));
  }
  return found;
}

}  // namespace collarmesh::shells
