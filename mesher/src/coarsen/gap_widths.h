#pragma once

#include "collarmesh/plc.h"
#include "tolerance/facing.h"

namespace collarmesh::coarsening {

/// How far the surface is from what it faces across a region, as the refinement measures it: along the
/// normal, by what turns towards it.
class GapWidths {
 public:
  /// Kept by reference.
  explicit GapWidths(const Plc& plc) : plc_(plc), facing_(plc) {}

  /// From a point on a patch; `widest` when there is nothing nearer.
  double from(const Point& p, Index patch, double widest);

 private:
  const Plc& plc_;
  const FacingSurfaces facing_;
  FacingSurfaces::Crossings crossings_;
};

}  // namespace collarmesh::coarsening
