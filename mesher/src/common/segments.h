#pragma once

#include <array>
#include <vector>

#include "collarmesh/plc.h"

namespace collarmesh {

/// Visits the two points of each segment of a curve's polyline, in its direction.
template <class Visit>
void visit_segments(const Plc::Curve& curve, const Visit& visit) {
  for (std::size_t i = 0; i + 1 < curve.points.size(); ++i) visit(curve.points[i], curve.points[i + 1]);
  if (curve.closed) visit(curve.points.back(), curve.points[0]);
}

/// Returns the segments of a curve as triangles without area.
inline std::vector<std::array<Index, 3>> flat_triangles_of(const Plc::Curve& curve) {
  std::vector<std::array<Index, 3>> triangles;
  visit_segments(curve, [&](Index a, Index b) { triangles.push_back({a, b, b}); });
  return triangles;
}

}  // namespace collarmesh
