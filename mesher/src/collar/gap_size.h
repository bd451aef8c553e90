#pragma once

#include "collar/feature_hierarchy.h"

namespace collarmesh {

/// The gap size g of the paper (Definition 2) at points of vertices and curves: the distance to the
/// nearest feature that does not contain the point; infinite when all do.
/// Cost: logarithmic in the number of features and in what the nearest ones consist of.
class GapSize {
 public:
  /// Both are kept by reference.
  GapSize(const Plc& plc, const FeatureHierarchy& features) : plc_(plc), features_(features) {}

  double at_vertex(Index vertex) const;
  /// Precondition: p lies on the curve and is none of its ends.
  double on_curve(Index curve, const Point& p) const;

 private:
  const Plc& plc_;
  const FeatureHierarchy& features_;
};

}  // namespace collarmesh
