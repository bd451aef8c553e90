#include "tolerance/thickness.h"

#include <algorithm>
#include <cmath>

#include "collarmesh/plc_builder.h"
#include "tolerance/facing.h"

namespace collarmesh {

namespace {

Vector unit(const Vector& v) {
  const double length = norm(v);
  return length > 0 ? v / length : Vector{};
}

// Returns for each triangle the mean direction of the normals at its corners; on planar patches, the patch's
// normal. The normal at a corner is the sum of the normals of the patch's triangles there, weighted by area.
std::vector<Vector> smooth_normals(const Plc& plc) {
  std::vector<Vector> normals(plc.triangles.size()), at_point(plc.points.size());
  for (const Plc::Patch& patch : plc.patches) {
    const Index end = patch.first_triangle + patch.triangle_count;
    for (Index t = patch.first_triangle; t < end; ++t) {
      const auto& [a, b, c] = plc.triangles[t].points;
      normals[t] = cross(plc.points[b] - plc.points[a], plc.points[c] - plc.points[a]);
      for (const Index p : plc.triangles[t].points) at_point[p] = at_point[p] + normals[t];
    }
    std::vector<Vector> sums;
    for (Index t = patch.first_triangle; t < end; ++t) {
      Vector sum{};
      for (const Index p : plc.triangles[t].points) sum = sum + unit(at_point[p]);
      sums.push_back(patch.planar ? patch.normal : unit(sum));
    }
    for (Index t = patch.first_triangle; t < end; ++t) {
      normals[t] = sums[t - patch.first_triangle];
      for (const Index p : plc.triangles[t].points) at_point[p] = {};
    }
  }
  return normals;
}

}  // namespace

Thickness::Thickness(const Plc& plc)
    : plc_(plc), triangles_(plc.points, corners_of_triangles(plc)), normals_(smooth_normals(plc)) {
  constexpr double crease_angle = 60;  // the default of Bounds
  for (const Crease& crease : find_creases(plc, crease_angle))
    if (crease.kind == Crease::Kind::facets || crease.kind == Crease::Kind::patch_fold)
      creases_.insert(std::minmax(crease.features[0], crease.features[1]));
}

Thickness::Ray Thickness::ray(Index triangle, unsigned side) const {
  const auto [a, b, c] = triangles_.corners(triangle);
  return {(a + b + c) / 3, side == 0 ? -1 * normals_[triangle] : normals_[triangle]};
}

Thickness::Opposites Thickness::at(Index triangle, unsigned side, Crossings& crossings, double reach) const {
  Opposites opposites;
  const auto [centre, way] = ray(triangle, side);
  if (way == Vector{}) return opposites;
  const Index patch = plc_.triangles[triangle].patch, region = plc_.patches[patch].regions[side];
  const double diagonal = plc_.bounds.diagonal();
  const Index root = triangles_.root();
  // The ray starts at a small distance from the triangle, because a start in its plane would cause ties.
  triangles_.crossings(centre + 1e-9 * diagonal * way, centre + std::min(reach, diagonal) * way, {&root, 1},
                       crossings);
  for (const auto& [other, direction] : crossings) {
    const Index opposite_patch = plc_.triangles[other].patch;
    const double towards = dot(normals_[other], way);
    const unsigned from_side = towards > 0 ? 0 : 1;
    if (other == triangle || plc_.patches[opposite_patch].regions[from_side] != region) continue;
    const auto [p, q, r] = triangles_.corners(other);
    const Vector flat = cross(q - p, r - p);
    const double distance = dot(p - centre, flat) / dot(way, flat);
    if (!(distance > 0)) continue;
    const bool neighbours = are_neighbours(plc_, patch, opposite_patch);
    const bool is_wedge = neighbours && creases_.contains(std::minmax(patch, opposite_patch));
    if (distance < opposites.first.distance) {
      opposites.first = {distance, other, from_side, std::fabs(towards)};
      opposites.is_wedge = is_wedge;
    }
    if (!is_wedge && std::fabs(towards) >= least_facing(neighbours) && distance < opposites.apart.distance)
      opposites.apart = {distance, other, from_side, std::fabs(towards)};
  }
  return opposites;
}

}  // namespace collarmesh
