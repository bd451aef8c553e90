#pragma once

#include "collar/feature_hierarchy.h"

namespace collarmesh {

/// The gap size g of the paper (Definition 2) at points of vertices and curves: the distance to the nearest
/// feature that does not contain the point; infinite if all features contain it.
class GapSize {
 public:
  GapSize() = default;
  GapSize(const GapSize&) = delete;
  GapSize& operator=(const GapSize&) = delete;
  virtual ~GapSize() = default;

  /// Returns the gap size; may return `bound` if the gap size is `bound` or more.
  virtual double at_vertex(Index vertex, double bound = INFINITY) = 0;
  /// Returns the gap size at a point of a curve, with the same meaning of `bound`. Precondition: p lies on
  /// the curve and is neither of its ends.
  virtual double on_curve(Index curve, const Point& p, double bound = INFINITY) = 0;
};

/// Returns whether the other feature contains this vertex, or this curve except its ends.
bool contains(const Plc& plc, const Feature& other, const Feature& vertex_or_curve);

/// The gap size by queries to a hierarchy over all features, without a mesh. Cost: logarithmic in the number
/// of features and in the elements of the nearest ones.
class GapInHierarchy final : public GapSize {
 public:
  /// Keeps references to both.
  GapInHierarchy(const Plc& plc, const FeatureHierarchy& features) : plc_(plc), features_(features) {}

  double at_vertex(Index vertex, double bound = INFINITY) override;
  double on_curve(Index curve, const Point& p, double bound = INFINITY) override;

 private:
  const Plc& plc_;
  const FeatureHierarchy& features_;
};

}  // namespace collarmesh
