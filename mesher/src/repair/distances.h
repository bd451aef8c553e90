#pragma once

#include <array>
#include <span>

#include "collarmesh/geometry.h"

namespace collarmesh::repairing {

/// A triangle given by the positions of its corners.
using CornerPoints = std::array<Point, 3>;

/// The distances between a repaired surface and its input, absolute.
struct RepairDistances {
  double of_repaired = 0;  ///< largest distance of a point of the repaired surface from the input
  double of_input = 0;  ///< largest distance of a point of the input from the repaired surface; points that
                        ///< the repaired surface encloses do not count
  Point farthest_of_input;  ///< a point of the input at the distance `of_input`
};

/// Measures both distances, at the triangles' corners and at further points no farther apart than 1/50 of the
/// diagonal of the input's bounding box. Skips triangles that both surfaces have. `filled` are further
/// triangles of the repaired surface, which close holes: their own distances from the input do not count.
/// Leaves out parts of the input that the repaired surface encloses (winding number above 1/2), because
/// repair removes walls inside solids on purpose. Cost: O(n log n).
RepairDistances measure_distances(std::span<const CornerPoints> input, std::span<const CornerPoints> repaired,
                                  std::span<const CornerPoints> filled);

/// The volume that the input encloses, and how much of this volume a repaired surface no longer encloses;
/// both measured by winding numbers at places all over the input's bounding box.
struct KeptVolume {
  double input = 0;  ///< absolute; 0 if over 20% of the winding numbers inside are far from integers: the
                     ///< input is then not closed
  double lost = 0;   ///< volume of the lost part, absolute
  Point where;       ///< a place in the lost part, if any
};

/// Measures both volumes. Cost: that of some thousand winding numbers.
KeptVolume kept_volume(std::span<const CornerPoints> input, std::span<const CornerPoints> repaired);

}  // namespace collarmesh::repairing
