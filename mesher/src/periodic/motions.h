#pragma once

#include "collarmesh/tet_mesh.h"

namespace collarmesh::periodicity {

using Motion = TetMesh::Motion;

inline Motion translation(const Vector& by) {
  Motion motion;
  motion.shift = by;
  return motion;
}

/// Returns the rotation about the axis through a point. The direction may have any length; the rotation is
/// counterclockwise for a viewer at whom it points. Rotations by right angles about coordinate axes have no
/// rounding.
Motion rotation(const Point& through, const Vector& direction, double degrees);

/// Returns the inverse of a motion.
Motion inverse(const Motion& motion);

/// Returns the composition of two motions: first `first`, then `then`.
Motion composed(const Motion& first, const Motion& then);

}  // namespace collarmesh::periodicity
