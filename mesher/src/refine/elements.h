#pragma once

#include <array>
#include <vector>

#include "collarmesh/plc.h"
#include "common/segments.h"

namespace collarmesh {

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
