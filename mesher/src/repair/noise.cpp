#include "repair/noise.h"

#include <algorithm>
#include <numbers>

#include "collarmesh/plc_builder.h"
#include "facets/faults.h"
#include "facets/near_touching.h"

namespace collarmesh::repairing {

namespace {

constexpr double flat_angle = 1;  // degrees

bool is_short(const Plc& plc, const Plc::Curve& curve, double tolerance) {
  double length = 0;
  for (std::size_t i = 0; i + 1 < curve.points.size() && length < tolerance; ++i)
    length += distance(plc.points[curve.points[i]], plc.points[curve.points[i + 1]]);
  return length < tolerance;
}

double extent(const Plc& plc, Index patch) {
  Box box;
  const Plc::Patch& p = plc.patches[patch];
  for (Index t = p.first_triangle; t < p.first_triangle + p.triangle_count; ++t)
    for (const Index point : plc.triangles[t].points) box.add(plc.points[point]);
  return box.diagonal();
}

// Returns whether the patches at a crease stay closer to each other than the tolerance.
bool is_slit(const Plc& plc, const Crease& crease, double tolerance) {
  if (crease.kind != Crease::Kind::facets && crease.kind != Crease::Kind::facets_in_vertex) return false;
  const double radians = crease.angle * std::numbers::pi / 180;
  return std::min(extent(plc, crease.features[0]), extent(plc, crease.features[1])) * radians < tolerance;
}

}  // namespace

std::optional<Point> find_noise(const Plc& plc, double tolerance) {
  if (!(tolerance > 0)) return std::nullopt;
  for (const Plc::Curve& curve : plc.curves)
    if (is_short(plc, curve, tolerance)) return plc.points[curve.points.front()];
  for (const Crease& crease : find_creases(plc, flat_angle))
    if (is_slit(plc, crease, tolerance)) return crease.where;
  facets::Faults faults;
  facets::find_near_touching(plc, tolerance, faults);
  if (faults.empty()) return std::nullopt;
  return faults.list().front().where;
}

std::vector<Trouble> find_troubles(const Plc& plc, double tolerance) {
  constexpr double of_short_curve = 1, of_near_features = 10, least_angle = 1e-6;
  std::vector<Trouble> troubles;
  for (const Plc::Curve& curve : plc.curves)
    if (is_short(plc, curve, tolerance))
      troubles.push_back({plc.points[curve.points.front()], of_short_curve});
  for (const Crease& crease : find_creases(plc, flat_angle))
    troubles.push_back({crease.where, flat_angle / std::max(crease.angle, least_angle)});
  facets::Faults faults;
  facets::find_near_touching(plc, tolerance, faults);
  for (const PlcFault& fault : faults.list()) troubles.push_back({fault.where, of_near_features});
  return troubles;
}

}  // namespace collarmesh::repairing
