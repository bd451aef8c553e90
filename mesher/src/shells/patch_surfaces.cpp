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
      last_found_(plc.patches.size(), 0) {
  for (Index patch = 0; patch < plc.patches.size(); ++patch) find_normals(patch);
}

// Weighted by areas, in which slivers of a tessellation do not count.
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

PatchSurfaces::Foot PatchSurfaces::nearest(Index patch, const Point& p) const {
  const TriangleHierarchy& tree = hierarchy(patch);
  Index& found = last_found_[patch];
  const auto hint = tree.corners(found);
  tree.squared_distance_to(p, squared_distance_to_triangle(p, hint[0], hint[1], hint[2]), &found);
  const Index triangle = plc_.patches[patch].first_triangle + found;
  const auto& [a, b, c] = plc_.triangles[triangle].points;
  const Point foot = nearest_point_on_triangle(p, plc_.points[a], plc_.points[b], plc_.points[c]);
  return {foot, normal_at(patch, triangle, foot), triangle, distance(p, foot),
          tolerance_.at_triangle(triangle)};
}

double PatchSurfaces::agreement(const Corners& t, Index patch) const { return fit(t, patch).agreement; }

PatchSurfaces::Fit PatchSurfaces::fit(const Corners& t, Index patch) const {
  const Vector area = area_vector(t);
  const double size = norm(area);
  if (planar(patch)) return {size > 0 ? dot(area, normals_[patch]) / size : -1, 0};
  const Foot foot = nearest(patch, (t[0] + t[1] + t[2]) / 3);
  return {size > 0 ? dot(area, foot.normal) / size : -1, foot.distance / foot.tolerance};
}

double PatchSurfaces::excess_between(Index patch, const Point& a, const Point& b) const {
  if (planar(patch)) return 0;
  double most = 0;
  for (const double share : {1.0 / 3, 2.0 / 3}) {
    const Foot foot = nearest(patch, a + share * (b - a));
    most = std::max(most, foot.distance / foot.tolerance);
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
