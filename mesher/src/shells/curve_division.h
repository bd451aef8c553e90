#pragma once

#include <array>
#include <functional>
#include <vector>

#include "collarmesh/surface_tolerance.h"
#include "shells/surface_sizes.h"

namespace collarmesh::shells {

/// Returns how far a curve's chord may be from a point of the complex.
using SagLimit = std::function<double(Index)>;

/// Returns the distance, relative to the limit, of a curve between two parameters from its chord.
double sag_between(const Plc& plc, const CurvePaths& paths, const SagLimit& limit, Index curve, double from,
                   double to);
/// Returns the same relative to the tolerance.
double sag_between(const Plc& plc, const CurvePaths& paths, const SurfaceTolerance& tolerance, Index curve,
                   double from, double to);

/// Returns the minimum number of edges of a curve: see below.
double least_edge_count(const Plc& plc, Index curve);

/// Returns places from one to another, both included, at distances that the target edge length, a function of
/// the place, asks for; there are at least this many distances. A number that is too small by less than
/// `rounding` is not rounded up.
std::vector<double> divide_by_size(const std::function<double(double)>& size, double from, double to,
                                   double least_count, double rounding);

/// Returns the arc lengths at which the edges of a curve begin and end; the last one is its length. There are
/// as many edges as the sizes ask for, and short enough to be within the limit. A closed curve has at least
/// three edges, and so has one that begins and ends at one vertex; a curve that has both ends in common with
/// another one has at least two unless it is straight. `tips` are the lengths of its first and its last edge,
/// 0 if these are free; tips are not divided. Cost: linear in its points and edges.
std::vector<double> divide_curve(const Plc& plc, const CurvePaths& paths, const SagLimit& limit,
                                 const SurfaceSizes& sizes, Index curve, const std::array<double, 2>& tips);

}  // namespace collarmesh::shells
