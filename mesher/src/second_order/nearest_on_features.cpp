#include "second_order/nearest_on_features.h"

#include "common/segments.h"

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
  curves_[id] = std::make_unique<TriangleHierarchy>(plc_.points, flat_triangles_of(plc_.curves[id]));
  return *curves_[id];
}

const TriangleHierarchy& NearestOnFeatures::patch(Index id) {
  if (!patches_[id]) patches_[id] = hierarchy_of_patch(plc_, id);
  return *patches_[id];
}

}  // namespace collarmesh::second_order
