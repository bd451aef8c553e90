#include "second_order/nearest_on_features.h"

namespace collarmesh::second_order {

Point NearestOnFeatures::nearest(const TetMesh::VertexFeature& feature, const Point& p) {
  const TriangleHierarchy& pieces = feature.dimension == 1 ? curve(feature.feature) : patch(feature.feature);
  Index at = none;
  pieces.squared_distance_to(p, INFINITY, &at);
  const auto [a, b, c] = pieces.corners(at);
  return nearest_point_on_triangle(p, a, b, c);
}

// Builds the hierarchy of a curve. Segments are triangles without area.
const TriangleHierarchy& NearestOnFeatures::curve(Index id) {
  if (curves_[id]) return *curves_[id];
  const Plc::Curve& curve = plc_.curves[id];
  std::vector<std::array<Index, 3>> segments;
  for (std::size_t i = 1; i < curve.points.size(); ++i)
    segments.push_back({curve.points[i - 1], curve.points[i], curve.points[i]});
  if (curve.closed) segments.push_back({curve.points.back(), curve.points.front(), curve.points.front()});
  curves_[id] = std::make_unique<TriangleHierarchy>(plc_.points, std::move(segments));
  return *curves_[id];
}

const TriangleHierarchy& NearestOnFeatures::patch(Index id) {
  if (!patches_[id]) patches_[id] = hierarchy_of_patch(plc_, id);
  return *patches_[id];
}

}  // namespace collarmesh::second_order
