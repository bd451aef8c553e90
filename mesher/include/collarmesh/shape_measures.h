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

/// Measures the complex's triangles and polylines.
ShapeMeasures measures_of(const Plc& plc);

/// Returns the deviation of a measure of the mesh from the input's in percent; NaN: the input has none.
inline double percent_off(double mesh, double input) { return 100 * (mesh - input) / input; }

/// Returns the largest relative deviation of a region's volume that elements of this order may have.
constexpr double volume_allowance(int order) { return order == 1 ? 0.05 : 0.01; }

/// The nodes of a triangle of second order: corners a, b, c, then the mid-edge nodes of ab, bc, ca.
using CurvedTriangle = std::array<Point, 6>;
/// The nodes of an edge of second order: its ends, then the one between.
using CurvedEdge = std::array<Point, 3>;

/// Returns the volume of a curved tet, exact except for rounding.
double volume(const CurvedTet& nodes);
/// Returns the area by quadrature of degree 4; exact if the triangle is straight.
double area(const CurvedTriangle& nodes);
/// Returns the length by quadrature of degree 5; exact if the edge is straight.
double length(const CurvedEdge& nodes);

}  // namespace collarmesh
