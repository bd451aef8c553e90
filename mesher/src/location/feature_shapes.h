#pragma once

#include <cmath>
#include <memory>
#include <vector>

#include "collarmesh/plc.h"
#include "collarmesh/tet_mesh.h"
#include "common/segments.h"
#include "location/triangle_hierarchy.h"

namespace collarmesh {

/// Returns the triangle nearest to p.
inline Index nearest_triangle(const TriangleHierarchy& triangles, const Point& p) {
  Index found = none;
  triangles.squared_distance_to(p, INFINITY, &found);
  return found;
}

/// The tessellated curves and patches of a complex, with hierarchies that are built on first use.
class FeatureShapes {
 public:
  /// Keeps the complex by reference.
  explicit FeatureShapes(const Plc& plc)
      : plc_(plc), curves_(plc.curves.size()), patches_(plc.patches.size()) {}

  /// Returns the segments of a curve, as triangles without area.
  const TriangleHierarchy& curve(Index curve) {
    auto& found = curves_[curve];
    if (!found)
      found = std::make_unique<TriangleHierarchy>(plc_.points, flat_triangles_of(plc_.curves[curve]));
    return *found;
  }
  /// Returns the triangles of a patch.
  const TriangleHierarchy& patch(Index patch) {
    if (!patches_[patch]) patches_[patch] = hierarchy_of_patch(plc_, patch);
    return *patches_[patch];
  }
  /// Returns the nearest point of a curve or patch.
  Point nearest(const TetMesh::VertexFeature& feature, const Point& p) {
    const TriangleHierarchy& pieces =
        feature.dimension == 1 ? curve(feature.feature) : patch(feature.feature);
    const auto [a, b, c] = pieces.corners(nearest_triangle(pieces, p));
    return nearest_point_on_triangle(p, a, b, c);
  }

 private:
  const Plc& plc_;
  std::vector<std::unique_ptr<TriangleHierarchy>> curves_, patches_;
};

}  // namespace collarmesh
