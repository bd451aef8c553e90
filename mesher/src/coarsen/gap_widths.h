#pragma once

#include <memory>
#include <vector>

#include "collarmesh/plc.h"
#include "collarmesh/tet_mesh.h"
#include "location/triangle_hierarchy.h"

namespace collarmesh::coarsening {

/// How far the surface is from what it faces across a region, as the refinement measures it: along the
/// normal, by what turns towards it.
class GapWidths {
 public:
  /// Kept by reference.
  explicit GapWidths(const Plc& plc);

  /// From a point on a patch; `widest` when there is nothing nearer.
  double from(const Point& p, Index patch, double widest);

 private:
  double towards(Index triangle, const Point& x, const Vector& normal, const Vector& way, Index patch,
                 double widest) const;

  const Plc& plc_;
  TriangleHierarchy triangles_;
  std::vector<TriangleHierarchy::Crossing> crossings_;
};

}  // namespace collarmesh::coarsening
