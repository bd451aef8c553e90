#pragma once

#include "collarmesh/plc.h"
#include "tolerance/facing.h"

namespace collarmesh::coarsening {

/// Measures the distance of the surface from the features that it faces across a region, as the refinement
/// does: along the normal, among triangles turned towards it.
class GapWidths {
 public:
  /// Keeps a reference to the complex.
  explicit GapWidths(const Plc& plc) : plc_(plc), facing_(plc) {}

  /// Returns the distance from a point on a patch; `widest` when there is nothing nearer.
  double from(const Point& p, Index patch, double widest);

 private:
  const Plc& plc_;
  const FacingSurfaces facing_;
  FacingSurfaces::Crossings crossings_;
};

}  // namespace collarmesh::coarsening
