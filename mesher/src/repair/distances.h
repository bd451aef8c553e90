#pragma once

#include <array>
#include <span>

#include "collarmesh/geometry.h"

namespace collarmesh::repairing {

/// Triangles by their corners' positions. Which corners are one does not matter.
using CornerPoints = std::array<Point, 3>;

/// How far a repaired surface and what it was made of are from each other, absolute.
struct RepairDistances {
  double of_repaired = 0;  ///< of a point of the repaired surface from the input
  double of_input =
      0;  ///< of a point of the input, but of those inside of what the repaired one encloses, from it
  Point farthest_of_input;  ///< such a point
};

/// Both, at points of the triangles no farther apart than 1/50 of the diagonal, corners among them. Triangles
/// that are in both are near. `filled` triangles of the repaired surface are left out: they are far from the
/// input by intention; so is what the repaired surface encloses (winding number above 1/2), as walls inside
/// are meant to vanish. Cost: O(n log n).
RepairDistances measure_distances(std::span<const CornerPoints> input, std::span<const CornerPoints> repaired,
                                  std::span<const CornerPoints> filled);

/// What a repaired surface encloses of what the input enclosed, by winding numbers at places all over the
/// box.
struct KeptVolume {
  double input =
      0;  ///< absolute; 0 unless most winding numbers are nearly whole: else it is no closed surface
  double lost = 0;  ///< of it, absolute
  Point where;      ///< a place that is lost, if any
};

/// Cost: that of some thousand winding numbers.
KeptVolume kept_volume(std::span<const CornerPoints> input, std::span<const CornerPoints> repaired);

}  // namespace collarmesh::repairing
