#pragma once

#include "collarmesh/tet_mesh.h"

namespace collarmesh::periodicity {

using Motion = TetMesh::Motion;

inline Motion translation(const Vector& by) {
  Motion motion;
  motion.shift = by;
  return motion;
}

/// The rotation about the axis through a point with a direction of any length, counterclockwise as seen
/// against it. Right angles have no rounding about axes of coordinates.
Motion rotation(const Point& through, const Vector& direction, double degrees);

/// Undoes one.
Motion inverse(const Motion& motion);

/// First one, then the other.
Motion composed(const Motion& first, const Motion& then);

}  // namespace collarmesh::periodicity
