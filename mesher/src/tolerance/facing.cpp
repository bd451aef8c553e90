#include "tolerance/facing.h"

namespace collarmesh {

namespace {

bool share(const std::vector<Index>& a, const std::vector<Index>& b) {  // both sorted
  for (auto i = a.begin(), j = b.begin(); i != a.end() && j != b.end();) {
    if (*i == *j) return true;
    *i < *j ? ++i : ++j;
  }
  return false;
}

bool meet(const Plc::Patch& a, const Plc::Patch& b) {
  return share(a.curves, b.curves) || share(a.vertices, b.vertices);
}

Vector normal_of(const std::array<Point, 3>& t) { return cross(t[1] - t[0], t[2] - t[0]); }

}  // namespace

std::vector<std::array<Index, 3>> corners_of_triangles(const Plc& plc) {
  std::vector<std::array<Index, 3>> triangles;
  triangles.reserve(plc.triangles.size());
  for (const Plc::Triangle& t : plc.triangles) triangles.push_back(t.points);
  return triangles;
}

bool are_neighbours(const Plc& plc, Index patch, Index other) {
  return patch == other || meet(plc.patches[patch], plc.patches[other]);
}

double least_facing(bool neighbours) { return neighbours ? 0.966 : 0.5; }

double facing_distance(const Plc& plc, Index patch, const Point& x, const Vector& normal, const Vector& way,
                       Index triangle, const std::array<Point, 3>& corners) {
  const Index other = plc.triangles[triangle].patch;
  const Vector n = normal_of(corners);
  if (other == patch && dot(n, normal) > 0) return INFINITY;
  const double towards = dot(n, way);
  if (std::fabs(towards) < least_facing(are_neighbours(plc, patch, other)) * norm(n)) return INFINITY;
  return dot(corners[0] - x, n) / towards;
}

FacingSurfaces::FacingSurfaces(const Plc& plc)
    : plc_(plc), triangles_(plc.points, corners_of_triangles(plc)) {}

FacingSurfaces::Facing FacingSurfaces::from(const Point& x, Index triangle, unsigned side, double widest,
                                            Crossings& crossings) const {
  Facing facing;
  Vector normal = normal_of(triangles_.corners(triangle));
  const double length = norm(normal);
  if (!(length > 0)) return facing;
  normal = normal / length;
  const Vector way = side == 0 ? -1 * normal : normal;
  const Index root = triangles_.root(), patch = plc_.triangles[triangle].patch;
  // The ray starts at a small distance from the triangle, because a start in its plane would cause ties.
  triangles_.crossings(x + 1e-6 * widest * way, x + widest * way, {&root, 1}, crossings);
  for (const auto& [other, direction] : crossings) {
    const double distance = facing_distance(plc_, patch, x, normal, way, other, triangles_.corners(other));
    if (distance < facing.distance && distance <= widest) facing = {distance, other};
  }
  return facing;
}

}  // namespace collarmesh
