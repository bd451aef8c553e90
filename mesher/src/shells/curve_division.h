#pragma once

#include <array>
#include <functional>
#include <vector>

#include "collarmesh/surface_tolerance.h"
#include "shells/surface_sizes.h"

namespace collarmesh::shells {

/// A function from a point of the complex to the allowed distance between a curve there and its chord.
using SagLimit = std::function<double(Index)>;

/// Returns the largest distance of a curve's points between two arc lengths from the chord between these
/// places. Each distance is divided by the limit at its point.
double sag_between(const Plc& plc, const CurvePaths& paths, const SagLimit& limit, Index curve, double from,
                   double to);
/// Returns the same with the tolerance as the limit.
double sag_between(const Plc& plc, const CurvePaths& paths, const SurfaceTolerance& tolerance, Index curve,
                   double from, double to);

/// Returns the minimum number of edges of a curve (see `divide_curve`).
double least_edge_count(const Plc& plc, Index curve);

/// Divides the interval between two places, both included in the result, into pieces of about the length
/// `size`, a function of the place. Makes at least `least_count` pieces. If the number by size exceeds an
/// integer by at most `rounding`, rounds it down.
std::vector<double> divide_by_size(const std::function<double(double)>& size, double from, double to,
                                   double least_count, double rounding);

/// Returns the arc lengths at which the edges of a curve begin and end; the last one is the curve's length.
/// Edges are about as long as the sizes ask for, or shorter so that the chords keep the limit. A closed
/// curve, or a loop at one vertex, has at least three edges. A curve that shares both ends with another curve
/// has at least two, unless it is straight. `tips` are the lengths of the first and the last edge, 0 if
/// these are free; tips are not divided. Cost: linear in the curve's points and edges.
std::vector<double> divide_curve(const Plc& plc, const CurvePaths& paths, const SagLimit& limit,
                                 const SurfaceSizes& sizes, Index curve, const std::array<double, 2>& tips);

}  // namespace collarmesh::shells
