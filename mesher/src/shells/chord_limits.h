#pragma once

#include <span>
#include <utility>
#include <vector>

#include "collarmesh/surface_tolerance.h"
#include "shells/surface_complex.h"

namespace collarmesh::shells {

/// The allowed distances of chords from the points of a complex: the tolerance or, where curves are near each
/// other, a smaller distance, so that their chords do not cross.
class ChordLimits {
 public:
  /// Measures the distances between curves in the triangles of `complex`, whose vertex i is the point
  /// `point_of[i]` of `plc`. Keeps all but the complex by reference. Cost: linear.
  ChordLimits(const SurfaceComplex& complex, const Plc& plc, const std::vector<Index>& point_of,
              const SurfaceTolerance& tolerance);

  /// Returns the limit at a point. Does not consider distances across the patches `without`.
  double at_point(Index point, std::span<const Index> without = {}) const;

 private:
  const SurfaceTolerance& tolerance_;
  std::vector<std::vector<std::pair<Index, double>>> narrow_;  // by point: patches with their limits
};

}  // namespace collarmesh::shells
