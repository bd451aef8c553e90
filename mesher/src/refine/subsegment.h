#pragma once

#include <array>

#include "collarmesh/geometry.h"

namespace collarmesh {

/// A piece of a curve between two consecutive points, with its protective ball, whose centre is where the
/// curve meets the bisector plane of the ends.
struct Subsegment {
  Index curve;
  std::array<Index, 2> ends;         ///< mesh vertices; none while the point is unresolved
  std::array<double, 2> parameters;  ///< arc length along the curve
  Point centre;
  double centre_parameter;
  double squared_radius;

  /// Returns whether both ends are in the mesh.
  bool resolved() const { return ends[0] != none && ends[1] != none; }
};

}  // namespace collarmesh
