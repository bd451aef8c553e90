#pragma once

#include "collar/feature_hierarchy.h"

namespace collarmesh {

/// The gap size g of the paper (Definition 2) at points of vertices and curves: the distance to the
/// nearest feature that does not contain the point; infinite when all do.
class GapSize {
 public:
  GapSize() = default;
  GapSize(const GapSize&) = delete;
  GapSize& operator=(const GapSize&) = delete;
  virtual ~GapSize() = default;

  /// Where it is `bound` or more, `bound` may be returned.
  virtual double at_vertex(Index vertex, double bound = INFINITY) = 0;
  /// Precondition: p lies on the curve and is none of its ends.
  virtual double on_curve(Index curve, const Point& p, double bound = INFINITY) = 0;
};

/// Does the other feature contain this vertex, or this curve without its ends?
bool contains(const Plc& plc, const Feature& other, const Feature& vertex_or_curve);

/// Found in a hierarchy over all features, without a mesh.
/// Cost: logarithmic in the number of features and in what the nearest ones consist of.
class GapInHierarchy final : public GapSize {
 public:
  /// Both are kept by reference.
  GapInHierarchy(const Plc& plc, const FeatureHierarchy& features) : plc_(plc), features_(features) {}

  double at_vertex(Index vertex, double bound = INFINITY) override;
  double on_curve(Index curve, const Point& p, double bound = INFINITY) override;

 private:
  const Plc& plc_;
  const FeatureHierarchy& features_;
};

}  // namespace collarmesh
