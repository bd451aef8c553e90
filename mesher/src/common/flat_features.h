#pragma once

#include <optional>
#include <vector>

#include "collarmesh/exact_geometry.h"
#include "collarmesh/plc.h"

namespace collarmesh {

/// The limits that keep straight curves and planar patches flat when their nodes move onto exact geometry.
/// The exact geometry may deviate from the line or plane by the tolerance of the CAD shape, which can be more
/// than the deviation of the tessellation's points.
class FlatFeatures {
 public:
  /// Keeps a reference to the complex. Cost: linear in the triangles.
  explicit FlatFeatures(const Plc& plc);

  /// Returns the exact geometry with its places kept near straight curves and planar patches: a place beyond
  /// a limit is moved back to it. For a planar patch the limit is the distance from its plane that the
  /// certificate permits: min(4 d, planar tolerance) + rounding, where d is the largest distance of the
  /// patch's points from the plane. For a straight curve it is the distance min(4 d, planar tolerance) / 2 +
  /// rounding from the curve's polyline, where d is the largest distance of the polyline's points from the
  /// line between its ends. (Only half, because mesh edges must also be near the polyline's points, which can
  /// be 2 d off a chord.) The result gives no point where `exact` gives none, or if on a curve no place
  /// within all limits is found. Keeps references to this object and to `exact`.
  ExactGeometry limit(const ExactGeometry& exact) const;

  /// Applies the limits to one place on the exact geometry of a curve (dimension 1) or patch (2). Returns
  /// nothing if it finds no place within all of them.
  std::optional<Point> keep(unsigned dimension, Index feature, Point place) const;

 private:
  bool put_on_curve(Index curve, Point& p) const;
  bool put_on_plane(Index patch, Point& p) const;

  const Plc& plc_;
  // Limits on the distance from the polyline or plane, absolute; infinite for features that are not flat.
  std::vector<double> curve_room_, patch_room_;
};

}  // namespace collarmesh
