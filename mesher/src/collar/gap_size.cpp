#include <algorithm>

#include "collar/collar_system.h"

namespace collarmesh {

namespace {

// Every feature as triangles: patches are, segments and points are degenerate ones.
std::vector<std::array<Index, 3>> element_triangles(const Plc& plc) {
  std::vector<std::array<Index, 3>> triangles;
  for (const auto& t : plc.triangles) triangles.push_back(t.points);
  for (const auto& curve : plc.curves) {
    const auto& p = curve.points;
    for (std::size_t i = 0; i + 1 < p.size(); ++i) triangles.push_back({p[i], p[i + 1], p[i + 1]});
    if (curve.closed) triangles.push_back({p.back(), p[0], p[0]});
  }
  for (const auto& vertex : plc.vertices) triangles.push_back({vertex.point, vertex.point, vertex.point});
  return triangles;
}

}  // namespace

GapSize::GapSize(const Plc& plc, std::span<const Point> points)
    : plc_(plc), points_(points), hierarchy_(points, element_triangles(plc)) {
  for (const auto& t : plc.triangles) elements_.push_back({2, t.patch});
  for (Index c = 0; c < plc.curves.size(); ++c)
    elements_.insert(elements_.end(), plc.curves[c].points.size() - (plc.curves[c].closed ? 0 : 1), {1, c});
  for (Index v = 0; v < plc.vertices.size(); ++v) elements_.push_back({0, v});
}

double GapSize::at_vertex(Index vertex) const {
  return std::sqrt(hierarchy_.squared_distance_to(
      points_[plc_.vertices[vertex].point], INFINITY, nullptr, [&](Index element) {
        const auto [dimension, feature] = elements_[element];
        if (dimension == 0) return feature != vertex;
        if (dimension == 1) return !plc_.vertex_on_curve(vertex, feature);
        return !plc_.vertex_on_patch(vertex, feature);
      }));
}

double GapSize::on_curve(Index curve, const Point& p) const {
  return std::sqrt(hierarchy_.squared_distance_to(p, INFINITY, nullptr, [&](Index element) {
    const auto [dimension, feature] = elements_[element];
    if (dimension == 0) return true;
    if (dimension == 1) return feature != curve;
    return !plc_.curve_on_patch(curve, feature);
  }));
}

bool GapSize::crosses(Index patch, const Point& p, const Point& q) const {
  const Index root = hierarchy_.root();
  std::vector<TriangleHierarchy::Crossing> crossings;
  hierarchy_.crossings(p, q, {&root, 1}, crossings);
  return std::any_of(crossings.begin(), crossings.end(), [&](const auto& crossing) {
    const Element& element = elements_[crossing.triangle];
    return element.dimension == 2 && element.feature == patch;
  });
}

Point GapSize::nearest_on_patch(Index patch, const Point& p) const {
  Index nearest = none;
  hierarchy_.squared_distance_to(p, INFINITY, &nearest, [&](Index element) {
    return elements_[element].dimension == 2 && elements_[element].feature == patch;
  });
  const auto t = hierarchy_.corners(nearest);
  return nearest_point_on_triangle(p, t[0], t[1], t[2]);
}

}  // namespace collarmesh
