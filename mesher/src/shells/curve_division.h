#pragma once

#include <vector>

#include "collarmesh/surface_tolerance.h"
#include "shells/surface_sizes.h"

namespace collarmesh::shells {

/// Returns the distance of a curve between two of its parameters from the chord there, by the tolerance.
double sag_between(const Plc& plc, const CurvePaths& paths, const SurfaceTolerance& tolerance, Index curve,
                   double from, double to);

/// Returns the arc lengths at which the edges of a curve begin and end, the last one its length: as many as
/// the sizes ask for, so short that they are within the tolerance of it. A closed curve has at least three,
/// and so has one that begins and ends at one vertex; one with the ends of another one has two unless it is
/// straight. Cost: linear in its points and edges.
std::vector<double> divide_curve(const Plc& plc, const CurvePaths& paths, const SurfaceTolerance& tolerance,
                                 const SurfaceSizes& sizes, Index curve);

}  // namespace collarmesh::shells
