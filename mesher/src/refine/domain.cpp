#include "refine/domain.h"

#include <algorithm>
#include <cmath>

namespace collarmesh {

namespace {

constexpr double floor_per_diagonal = 1e-10;
// Segments of curves shorter than this share of the diagonal are tiny edges. Near them the floor is lower, in
// proportion to their length, but not below double precision.
constexpr double tiny_per_diagonal = 1e-5, floor_per_tiny_edge = floor_per_diagonal / tiny_per_diagonal;
constexpr double precise_per_diagonal = 1e-13, precise_per_coordinate = 500 * 2.2e-16;
constexpr double reach_of_tiny_edge = 10;  // distance up to which it lowers the floor, in its lengths
// The share of the distance tolerance that refinement aims at, because it tests only a few points of a face.
constexpr double distance_reserve = 0.75;

// Returns a box whose margin around the bounds is slightly different along each axis, so that its corners are
// not cospherical with points of symmetric input.
Box surrounding_box(const Box& bounds) {
  const Vector sides = bounds.max - bounds.min;
  const double extent = std::max({sides.x, sides.y, sides.z});
  const Vector reach = 0.5 * sides + extent * Vector{0.87, 0.89, 0.91};
  Box box;
  box.add(bounds.centre() - reach);
  box.add(bounds.centre() + reach);
  return box;
}

Box framed(const Box& bounds, const Frame& frame) {
  Box box;
  box.add(frame.inside(bounds.min));
  box.add(frame.inside(bounds.max));
  return box;
}

std::vector<Point> framed(const std::vector<Point>& points, const Frame& frame) {
  std::vector<Point> moved;
  moved.reserve(points.size());
  for (const Point& p : points) moved.push_back(frame.inside(p));
  return moved;
}

}  // namespace

Domain::Domain(const Plc& complex, const MeshOptions& mesh_options)
    : plc(complex),
      options(mesh_options),
      frame(plc.bounds),
      points(framed(plc.points, frame)),
      patch_points(plc),
      paths(plc, points),
      diagonal(plc.bounds.diagonal()),
      tolerance(tolerance_of(plc, options.bounds, options.size).scaled(distance_reserve)),
      floor(floor_per_diagonal * diagonal),
      box(surrounding_box(framed(plc.bounds, frame))),
      tiny_edges_(tiny_edges()) {}

std::vector<Domain::TinyEdge> Domain::tiny_edges() const {
  std::vector<TinyEdge> found;
  for (Index c = 0; c < plc.curves.size(); ++c)
    for (std::size_t i = 0; i + 1 < paths.lengths(c).size(); ++i) {
      const auto [a, b] = paths.segment_ends(c, i);
      const double length = distance(points[a], points[b]);
      if (length < tiny_per_diagonal * diagonal)
        found.push_back({points[a] + 0.5 * (points[b] - points[a]), length});
    }
  return found;
}

// Returns the floor at a place. Tests all tiny edges, because queries are rare: `at_floor` makes one only for
// a ball below the floor of the whole domain.
double Domain::floor_at(const Point& p) const {
  double edge = tiny_per_diagonal * diagonal;
  for (const auto& [middle, length] : tiny_edges_)
    if (length < edge && distance(p, middle) < reach_of_tiny_edge * length) edge = length;
  const Point outside = frame.outside(p);
  const double coordinate = std::max({std::fabs(outside.x), std::fabs(outside.y), std::fabs(outside.z)});
  const double precise = std::max(precise_per_diagonal * diagonal, precise_per_coordinate * coordinate);
  return std::min(floor, std::max(floor_per_tiny_edge * edge, precise));
}

// Returns the nearest point in the plane of the patch. Uses the patch's normal, because normals of needle
// triangles are unreliable in a facet that is planar only within a tolerance.
Point Domain::on_plane(Index patch, const Point& p) const {
  const Plc::Patch& plane = plc.patches[patch];
  return p - dot(p - frame.inside(plane.origin), plane.normal) * plane.normal;
}

}  // namespace collarmesh
