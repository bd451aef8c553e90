#pragma once

#include <vector>

#include "collarmesh/curved_tet.h"
#include "collarmesh/plc.h"

namespace collarmesh {

/// Sizes of the features of a shape, in powers of the input's unit.
struct ShapeMeasures {
  std::vector<double> volumes;  ///< by region; [0], the outside, is 0
  std::vector<double> areas;    ///< by patch
  std::vector<double> lengths;  ///< by curve
};

/// As the complex's triangles and polylines have them.
ShapeMeasures measures_of(const Plc& plc);

/// By how much a measure of the mesh differs from the input's, in percent of this; NaN: the input has none.
inline double percent_off(double mesh, double input) { return 100 * (mesh - input) / input; }

/// By how much the volume of a region may differ from the input's, relatively, for elements of this order.
constexpr double volume_allowance(int order) { return order == 1 ? 0.05 : 0.01; }

/// The nodes of a triangle of second order: corners a, b, c, then those amid ab, bc, ca.
using CurvedTriangle = std::array<Point, 6>;
/// The nodes of an edge of second order: its ends, then the one between.
using CurvedEdge = std::array<Point, 3>;

/// Exact but for rounding.
double volume(const CurvedTet& nodes);
/// By quadrature of degree 4; exact where the triangle is straight.
double area(const CurvedTriangle& nodes);
/// By quadrature of degree 5; exact where the edge is straight.
double length(const CurvedEdge& nodes);

}  // namespace collarmesh
