#pragma once

#include "collarmesh/plc.h"

namespace collarmesh {

/// Sums over the triangles on planar sides of walls, gaps and wedges that are thinner than this (absolute):
/// the area of a triangle, divided by the square of the thickness at its centre. A refinement with bounded
/// ratios makes up to this many vertices. Leaves out curved sides: walls between them are often thin only in
/// a strip, as between cylinders that nearly touch, and `has_thin_shells` finds curved walls that are thin
/// throughout. Cost: near linear in the triangles.
double squares_in_thin_places(const Plc& plc, double thinner_than);

}  // namespace collarmesh
