#pragma once

#include <array>
#include <functional>
#include <vector>

#include "collarmesh/surface_tolerance.h"
#include "shells/surface_sizes.h"

namespace collarmesh::shells {

/// How far a curve's chord may be from a point of the complex.
using SagLimit = std::function<double(Index)>;

/// Returns the distance of a curve between two of its parameters from the chord there, by the limit.
double sag_between(const Plc& plc, const CurvePaths& paths, const SagLimit& limit, Index curve, double from,
                   double to);
/// The same by the tolerance.
double sag_between(const Plc& plc, const CurvePaths& paths, const SurfaceTolerance& tolerance, Index curve,
                   double from, double to);

/// Returns the number of edges that a curve has at least: see below.
double least_edge_count(const Plc& plc, Index curve);

/// Returns places from one to another, both included, whose distances are as the target edge length asks,
/// which is a function of the place; there are so many distances at least. A number of them that is too small
/// by less than `rounding` is not rounded up.
std::vector<double> divide_by_size(const std::function<double(double)>& size, double from, double to,
                                   double least_count, double rounding);

/// Returns the arc lengths at which the edges of a curve begin and end, the last one its length: as many as
/// the sizes ask for, so short that they are within the limit of it. A closed curve has at least three,
/// and so has one that begins and ends at one vertex; one with the ends of another one has two unless it is
/// straight. `tips`: lengths of its first and its last edge, 0 where these are free; they are not divided.
/// Cost: linear in its points and edges.
std::vector<double> divide_curve(const Plc& plc, const CurvePaths& paths, const SagLimit& limit,
                                 const SurfaceSizes& sizes, Index curve, const std::array<double, 2>& tips);

}  // namespace collarmesh::shells
