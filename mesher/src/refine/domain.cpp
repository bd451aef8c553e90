#include "refine/domain.h"

#include <algorithm>

namespace collarmesh {

namespace {

constexpr double floor_per_diagonal = 1e-10;
// The share of the distance tolerance that refinement aims at: it looks at a few points of a face.
constexpr double distance_reserve = 0.75;

// Slightly different in each axis so that its corners are not cospherical with points of symmetric input.
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
      box(surrounding_box(framed(plc.bounds, frame))) {}

// Needle triangles of a facet that is planar within a tolerance only have normals of their own.
Point Domain::on_plane(Index patch, const Point& p) const {
  const Plc::Patch& plane = plc.patches[patch];
  return p - dot(p - frame.inside(plane.origin), plane.normal) * plane.normal;
}

}  // namespace collarmesh
