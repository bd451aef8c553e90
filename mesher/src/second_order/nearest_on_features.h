#pragma once

#include <memory>
#include <vector>

#include "collarmesh/plc.h"
#include "collarmesh/tet_mesh.h"
#include "location/triangle_hierarchy.h"

namespace collarmesh::second_order {

/// Finds the nearest points of the tessellated curves and patches of a complex.
class NearestOnFeatures {
 public:
  /// Keeps the complex by reference.
  explicit NearestOnFeatures(const Plc& plc)
      : plc_(plc), curves_(plc.curves.size()), patches_(plc.patches.size()) {}

  Point nearest(const TetMesh::VertexFeature& feature, const Point& p);

 private:
  const TriangleHierarchy& curve(Index id);
  const TriangleHierarchy& patch(Index id);

  const Plc& plc_;
  std::vector<std::unique_ptr<TriangleHierarchy>> curves_, patches_;  // built on first use
};

}  // namespace collarmesh::second_order
