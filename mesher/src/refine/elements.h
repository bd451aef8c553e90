#pragma once

#include <array>
#include <vector>

#include "collarmesh/plc.h"

namespace collarmesh {

/// Visits the two points of each segment of a curve's polyline.
template <class Visit>
void visit_segments(const Plc::Curve& curve, const Visit& visit) {
  for (std::size_t i = 0; i + 1 < curve.points.size(); ++i) visit(curve.points[i], curve.points[i + 1]);
  if (curve.closed) visit(curve.points.back(), curve.points[0]);
}

/// Returns the corners of the elements of a complex: first its triangles, then, as degenerate triangles,
/// features on no patch: the segments of curves and single vertices.
inline std::vector<std::array<Index, 3>> elements_of(const Plc& plc) {
  std::vector<std::array<Index, 3>> elements;
  elements.reserve(plc.triangles.size());
  for (const Plc::Triangle& t : plc.triangles) elements.push_back(t.points);
  for (const Plc::Curve& curve : plc.curves)
    if (curve.patches.empty())
      visit_segments(curve, [&](Index a, Index b) { elements.push_back({a, b, b}); });
  for (const Plc::Vertex& vertex : plc.vertices)
    if (vertex.patches.empty() && vertex.curves.empty())
      elements.push_back({vertex.point, vertex.point, vertex.point});
  return elements;
}

}  // namespace collarmesh
