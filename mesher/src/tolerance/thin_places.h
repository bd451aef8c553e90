#pragma once

#include "collarmesh/plc.h"

namespace collarmesh {

/// Estimates how many vertices a refinement with bounded radius-edge ratios makes in thin places at most:
/// adds up the areas of triangles, each divided by the square of the thickness at its centre. Considers
/// triangles on planar sides of walls, gaps and wedges that are thinner than `thinner_than` (absolute).
/// Leaves out curved sides: walls between them are often thin only in a strip, as between cylinders that
/// nearly touch, and `has_thin_shells` finds curved walls that are thin throughout. Cost: near linear in the
/// triangles.
double squares_in_thin_places(const Plc& plc, double thinner_than);

}  // namespace collarmesh
