#pragma once

#include <span>
#include <utility>
#include <vector>

#include "collarmesh/surface_tolerance.h"
#include "shells/surface_complex.h"

namespace collarmesh::shells {

/// The largest allowed distances of chords from the points of their curves: the tolerance or, where curves
/// are near each other, less, so that their chords do not cross.
class ChordLimits {
 public:
  /// Measures the distances between curves in the triangles of `complex`. Vertex i of `complex` is the point
  /// `point_of[i]` of `plc`. Keeps the tolerance by reference. Cost: linear.
  ChordLimits(const SurfaceComplex& complex, const Plc& plc, const std::vector<Index>& point_of,
              const SurfaceTolerance& tolerance);

  /// Returns the limit at a point of the input. Ignores distances across the patches in `without`.
  double at_point(Index point, std::span<const Index> without = {}) const;

 private:
  const SurfaceTolerance& tolerance_;
  std::vector<std::vector<std::pair<Index, double>>> narrow_;  // by point: patches with their limits
};

}  // namespace collarmesh::shells
