#include "predict/shape.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "common/segments.h"
#include "tolerance/facing.h"

namespace collarmesh::prediction {

namespace {

std::vector<DistanceTree::Triangle> corners_of(const Plc& plc) {
  std::vector<DistanceTree::Triangle> corners;
  for (const auto& [a, b, c] : corners_of_triangles(plc))
    corners.push_back({plc.points[a], plc.points[b], plc.points[c]});
  return corners;
}

}  // namespace

Shape::Shape(const Plc& plc)
    : plc_(plc),
      radii_(curvature_sizes(plc, 2 * std::numbers::pi)),  // radii: the sizes for one element per radian
      angles_(solid_angles(plc)),
      surface_(plc.points, corners_of_triangles(plc)),
      tree_(corners_of(plc)),
      locator_(plc) {
  for (const Plc::Patch& patch : plc.patches) borders_.push_back(border_of(patch));
}

std::array<Point, 3> Shape::corners(Index triangle) const {
  const auto& [a, b, c] = plc_.triangles[triangle].points;
  return {plc_.points[a], plc_.points[b], plc_.points[c]};
}

std::size_t Shape::segment_count(Index curve) const {
  return plc_.curves[curve].points.size() - (plc_.curves[curve].closed ? 0 : 1);
}

std::array<Point, 2> Shape::segment(Index curve, std::size_t number) const {
  const auto& points = plc_.curves[curve].points;
  return {plc_.points[points[number]], plc_.points[points[(number + 1) % points.size()]]};
}

double Shape::distance_to_border(const Point& p, Index patch) const {
  return std::sqrt(borders_[patch].segments->squared_distance_to(p));
}

double Shape::strip_width(const Point& p, Index curve, const Vector& along, double widest) const {
  double squared = widest * widest;
  for (const Index patch : plc_.curves[curve].patches) {
    const Border& border = borders_[patch];
    squared = border.segments->squared_distance_to(p, squared, nullptr, [&](Index i) {
      const Index other = border.curve[i];
      if (other == curve) return false;
      const auto [a, b, same] = border.segments->corners(i);
      const double least = least_facing(curves_meet(curve, other));  // as in the measurement of gaps
      return std::fabs(dot(along, b - a)) > least * norm(along) * norm(b - a);
    });
  }
  return std::sqrt(squared);
}

double Shape::wall_width(const Point& p, Index triangle, double widest) const {
  const Index patch = plc_.triangles[triangle].patch;
  const auto [a, b, c] = corners(triangle);
  const Vector normal = cross(b - a, c - a);
  if (!(norm(normal) > 0)) return widest;
  const double least = least_facing(false);  // the same cosine as in the measurement of gaps
  double width = widest;
  std::vector<TriangleHierarchy::Crossing> crossings;
  for (unsigned side = 0; side < 2; ++side) {
    if (plc_.patches[patch].regions[side] == 0) continue;
    const Vector way = (side == 0 ? -1 : 1) / norm(normal) * normal;
    const Index root = surface_.root();
    // The ray starts at a small distance from the triangle, because a start in its plane would cause ties.
    surface_.crossings(p + 1e-6 * widest * way, p + widest * way, {&root, 1}, crossings);
    for (const auto& [other, direction] : crossings) {
      if (other == triangle || patches_meet(patch, plc_.triangles[other].patch)) continue;
      const auto [d, e, f] = corners(other);
      const Vector n = cross(e - d, f - d);
      if (std::fabs(dot(n, way)) < least * norm(n)) continue;
      width = std::min(width, dot(d - p, n) / dot(n, way));
    }
  }
  return std::max(width, 0.0);
}

Index Shape::region_at(const Point& p, Index nearest) const {
  // Least barycentric coordinate of points that are surely inside a triangle; largest height of a needle,
  // relative to its longest side.
  constexpr double inside = 1e-6, needle = 1e-4;
  if (nearest == none) return locator_.region_at(p);
  const auto [a, b, c] = corners(nearest);
  const Vector normal = cross(b - a, c - a);
  const double squared = dot(normal, normal),
               side = std::max({squared_distance(a, b), squared_distance(b, c), squared_distance(c, a)});
  const auto is_left_of = [&](const Point& from, const Point& to) {
    return dot(cross(to - from, p - from), normal) > inside * squared;
  };
  // If the nearest point is inside a triangle, the segment to it meets no other triangle.
  const bool is_inside =
      squared > needle * needle * side * side && is_left_of(a, b) && is_left_of(b, c) && is_left_of(c, a);
  return is_inside ? plc_.patches[plc_.triangles[nearest].patch].regions[dot(p - a, normal) > 0 ? 1 : 0]
                   : locator_.region_at(p);
}

Shape::Border Shape::border_of(const Plc::Patch& patch) const {
  Border border;
  std::vector<std::array<Index, 3>> segments;
  for (const Index curve : patch.curves) {
    visit_segments(plc_.curves[curve], [&](Index a, Index b) {
      segments.push_back({a, b, b});
      border.curve.push_back(curve);
    });
  }
  border.segments = std::make_unique<TriangleHierarchy>(plc_.points, std::move(segments));
  return border;
}

bool Shape::curves_meet(Index curve, Index other) const {
  const auto &a = plc_.curves[curve].ends, &b = plc_.curves[other].ends;
  return std::ranges::any_of(a, [&](Index v) { return v != none && (v == b[0] || v == b[1]); });
}

// Returns whether the patches meet in a curve: if so, the region between them is a wedge, not a wall.
bool Shape::patches_meet(Index patch, Index other) const {
  if (patch == other) return false;
  const auto &a = plc_.patches[patch].curves, &b = plc_.patches[other].curves;
  return std::ranges::any_of(a, [&](Index c) { return std::ranges::binary_search(b, c); });
}

}  // namespace collarmesh::prediction
