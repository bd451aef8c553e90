#pragma once

#include <optional>
#include <vector>

#include "collarmesh/exact_geometry.h"
#include "collarmesh/plc.h"

namespace collarmesh {

/// The limits that keep straight curves and planar patches flat when their nodes move onto exact geometry.
/// The exact geometry may deviate from the line or plane by the tolerance of the shape, which can be more
/// than the tessellation's points do.
class FlatFeatures {
 public:
  /// Keeps a reference to the complex. Cost: linear in the triangles.
  explicit FlatFeatures(const Plc& plc);

  /// Returns the exact geometry with its places kept near straight curves and planar patches. Places that are
  /// farther from a plane than the certificate permits are moved back to the limit, which is min(4 d, planar
  /// tolerance) plus rounding, where d is the distance of the complex's own points from the plane. For a
  /// straight curve the limit is half of that, because the edges between nodes must also be near the curve's
  /// own points, which are up to 2 d off the chords. Returns no point if it finds no such place. Keeps
  /// references to this object and to `exact`.
  ExactGeometry limit(const ExactGeometry& exact) const;

  /// Applies this restriction to one place on the exact geometry of a curve (dimension 1) or patch (2).
  std::optional<Point> keep(unsigned dimension, Index feature, Point place) const;

 private:
  bool put_on_curve(Index curve, Point& p) const;
  bool put_on_plane(Index patch, Point& p) const;

  const Plc& plc_;
  // Limits on the distance from the line or plane, absolute; infinite for features that are not flat.
  std::vector<double> curve_room_, patch_room_;
};

}  // namespace collarmesh
