#include "plc/fans.h"

#include <algorithm>

namespace collarmesh::plc {

using namespace facets;

namespace {

// A fan is too flat to fold if the cosines between all its normals and the first one exceed this.
constexpr double flat_fan_cosine = 0.866;

std::vector<Corners> corners_of(const std::vector<Plc::Triangle>& triangles) {
  std::vector<Corners> corners;
  corners.reserve(triangles.size());
  for (const Plc::Triangle& t : triangles) corners.push_back(t.points);
  return corners;
}

bool too_flat_to_fold(const Fan& fan) {
  Vector first{};
  for (std::size_t i = 0; i < fan.sector_count(); ++i) {
    const Sector s = fan.sector(i);
    const Vector n = cross(s.u, s.v);
    if (i == 0) first = n / norm(n);
    if (dot(first, n) < flat_fan_cosine * norm(n)) return false;
  }
  return true;
}

}  // namespace

PatchFans::PatchFans(std::span<const Point> points, const std::vector<Plc::Triangle>& triangles,
                     const std::vector<Plc::Patch>& patches, std::span<const std::array<Index, 2>> segments)
    : points_(points),
      patches_(patches),
      triangles_(corners_of(triangles)),
      edges_(triangles_, points.size()),
      is_segment_(edges_.size(), false) {
  patch_of_.reserve(triangles.size());
  for (const Plc::Triangle& t : triangles) patch_of_.push_back(t.patch);
  for (const auto& [a, b] : segments)
    if (const Index e = edges_.find(a, b); e != none) is_segment_[e] = true;
  triangles_at_ = {triangles_, points_.size()};
  visited_.assign(3 * triangles_.size(), false);
}

std::vector<Fan> PatchFans::at(Index point, bool smooth_only) {
  std::vector<Fan> fans;
  const auto corner_of = [&](Index t) {
    return 3 * t + (triangles_[t][0] == point ? 0 : triangles_[t][1] == point ? 1 : 2);
  };
  for (const Index t : triangles_at_[point]) {
    const Index start = corner_of(t);
    if (visited_[start] || (smooth_only && patches_[patch_of(start)].planar)) continue;
    fans.push_back(make_fan(start));
  }
  for (const Index t : triangles_at_[point]) visited_[corner_of(t)] = false;
  return fans;
}

Index PatchFans::across(Index side) const {
  const Index edge = edges_.edge_of(side);
  const auto sides = edges_.sides(edge);
  if (is_segment_[edge] || sides.size() != 2) return none;
  return sides[0] == side ? sides[1] : sides[0];
}

// Returns the corner that follows (counterclockwise) or precedes this one in its fan.
Index PatchFans::next_corner(Index corner) const {
  return across(corner - corner % 3 + (corner % 3 + 2) % 3);
}
Index PatchFans::previous_corner(Index corner) const {
  const Index side = across(corner);
  return side == none ? none : side - side % 3 + (side % 3 + 1) % 3;
}

Fan PatchFans::make_fan(Index start) {
  Index first = start;
  for (Index c = previous_corner(start); c != none && c != start; c = previous_corner(c)) first = c;
  Fan fan;
  fan.patch = patch_of(start);
  fan.closed = previous_corner(first) != none;
  const Index p = triangles_[start / 3][start % 3];
  Index last = first;
  for (Index c = first; c != none && !visited_[c]; c = next_corner(c)) {
    visited_[c] = true;
    last = c;
    fan.rim.push_back(triangles_[c / 3][(c % 3 + 1) % 3]);
  }
  if (!fan.closed) fan.rim.push_back(triangles_[last / 3][(last % 3 + 2) % 3]);
  if (!fan.closed && fan.rim.size() > 2 && fan.rim.front() == fan.rim.back()) {
    // If a segment ends inside the patch, its two sides are one ray.
    fan.rim.pop_back();
    fan.closed = true;
  }
  for (const Index q : fan.rim)
    fan.rays.push_back((points_[q] - points_[p]) / distance(points_[p], points_[q]));
  return fan;
}

double PatchFans::fold(Index point, const Fan& fan, double noise) const {
  const bool too_small = std::any_of(fan.rim.begin(), fan.rim.end(),
                                     [&](Index q) { return distance(points_[point], points_[q]) <= noise; });
  return too_small || too_flat_to_fold(fan) ? 180 : fold_angle(fan.rays, fan.closed);
}

}  // namespace collarmesh::plc
