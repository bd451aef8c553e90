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
  std::vector<double> shells;   ///< volumes enclosed by closed surfaces, in the order of `shells_of`
};

/// A closed surface that bounds a region or the outside but is not all of one region's boundary: around a
/// void, around one of several bodies of a region, around several regions that touch.
struct Shell {
  Index region = none;  ///< the region that it bounds, 0: the outside
  std::vector<Index> patches;
};

/// Returns the connected parts of the boundaries of regions and of the outside, without those that bound
/// one region alone, whose volume is the region's. Cost: near linear in the features.
std::vector<Shell> shells_of(const Plc& plc);

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
/// Returns the signed volume of the curved tet between a triangle and a point, whose edges to the point are
/// straight; positive where the triangle's normal (b-a) x (c-a) looks away from the point. Over a closed
/// surface the sum is what it encloses.
double volume_below(const Point& apex, const CurvedTriangle& nodes);
/// Returns the area by quadrature of degree 4; exact if the triangle is straight.
double area(const CurvedTriangle& nodes);
/// Returns the length by quadrature of degree 5; exact if the edge is straight.
double length(const CurvedEdge& nodes);

}  // namespace collarmesh
