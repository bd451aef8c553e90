#include "coarsen/gap_widths.h"

#include <algorithm>
#include <cmath>

namespace collarmesh::coarsening {

namespace {

// The cosine between a normal and that of what it faces; of parts of the surface that meet elsewhere only
// what is almost parallel counts, else gaps would close in wedges.
constexpr double least_facing = 0.5, least_facing_of_neighbours = 0.966;

std::vector<std::array<Index, 3>> triangles_of(const Plc& plc) {
  std::vector<std::array<Index, 3>> triangles;
  triangles.reserve(plc.triangles.size());
  for (const Plc::Triangle& t : plc.triangles) triangles.push_back(t.points);
  return triangles;
}

bool share(const std::vector<Index>& a, const std::vector<Index>& b) {  // sorted
  return std::any_of(a.begin(), a.end(), [&](Index i) { return std::binary_search(b.begin(), b.end(), i); });
}

Vector normal_of(const std::array<Point, 3>& t) { return cross(t[1] - t[0], t[2] - t[0]); }

}  // namespace

GapWidths::GapWidths(const Plc& plc) : plc_(plc), triangles_(plc.points, triangles_of(plc)) {}

double GapWidths::from(const Point& p, Index patch, double widest) {
  Index at = none;
  triangles_.squared_distance_to(p, INFINITY, &at, [&](Index t) { return plc_.triangles[t].patch == patch; });
  if (at == none) return widest;
  Vector normal = normal_of(triangles_.corners(at));
  normal = normal / norm(normal);
  double width = widest;
  for (unsigned side = 0; side < 2; ++side) {
    if (plc_.patches[patch].regions[side] == 0) continue;
    const Vector way = side == 0 ? -1 * normal : normal;
    const Index root = triangles_.root();
    // Not from the plane of its own triangle: that would be one tie after the other.
    triangles_.crossings(p + 1e-6 * widest * way, p + widest * way, {&root, 1}, crossings_);
    for (const auto& [triangle, direction] : crossings_)
      width = std::min(width, towards(triangle, p, normal, way, patch, widest));
  }
  return width;
}

double GapWidths::towards(Index triangle, const Point& x, const Vector& normal, const Vector& way,
                          Index patch, double widest) const {
  const Index other = plc_.triangles[triangle].patch;
  const auto corners = triangles_.corners(triangle);
  const Vector n = normal_of(corners);
  if (other == patch && dot(n, normal) > 0) return widest;
  const Plc::Patch &a = plc_.patches[patch], &b = plc_.patches[other];
  const bool meet = other == patch || share(a.curves, b.curves) || share(a.vertices, b.vertices);
  const double facing = dot(n, way);
  if (std::fabs(facing) < (meet ? least_facing_of_neighbours : least_facing) * norm(n)) return widest;
  return dot(corners[0] - x, n) / facing;
}

}  // namespace collarmesh::coarsening
