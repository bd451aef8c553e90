#pragma once

#include "collar/feature_hierarchy.h"
#include "delaunay/triangulation.h"

namespace collarmesh {

/// A point that may be inserted to destroy a ball (paper, Procedure 2). One part makes a candidate; others
/// test whether it encroaches their balls or warps to one of their points; the loop inserts it.
struct Candidate {
  Point point;
  double squared_radius;  ///< squared radius of the ball to destroy
  Point ball_centre;
  Feature feature;      ///< feature that the point lies on; dimension 3: none
  Index start;          ///< a cell in conflict with the point
  Index across = none;  ///< the mesh vertex that the point faces across a gap
};

}  // namespace collarmesh
