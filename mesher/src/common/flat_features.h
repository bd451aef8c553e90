#pragma once

#include <optional>
#include <vector>

#include "collarmesh/exact_geometry.h"
#include "collarmesh/plc.h"

namespace collarmesh {

/// What a complex calls straight or planar stays so when its nodes move onto exact geometry, which may
/// leave the line or plane: by the tolerance of the shape, or by more than the tessellation's points tell.
class FlatFeatures {
 public:
  /// Kept by reference. Cost: linear in the triangles.
  explicit FlatFeatures(const Plc& plc);

  /// The exact geometry as far as it stays with the straight curves and planar patches that the feature is,
  /// or is on: a place off a plane by more than the certificate permits (that is min(4 d, planar tolerance)
  /// and rounding, where d is how far the complex's own points are off), or off a straight curve by more than
  /// half of that, is moved back towards it. Half, because the edges between nodes must be near the curve's
  /// own points, too, and those are up to 2 d off the chords. Nothing where there is no such place near.
  /// This and `exact` are kept by reference.
  ExactGeometry limit(const ExactGeometry& exact) const;

  /// The same for one place on the exact geometry of a curve (dimension 1) or patch (2).
  std::optional<Point> keep(unsigned dimension, Index feature, Point place) const;

 private:
  bool put_on_curve(Index curve, Point& p) const;
  bool put_on_plane(Index patch, Point& p) const;

  const Plc& plc_;
  std::vector<double> curve_room_, patch_room_;  // absolute; infinite where nothing is flat
};

}  // namespace collarmesh
