#pragma once

#include <vector>

#include "collarmesh/curved_tet.h"
#include "collarmesh/plc.h"

namespace collarmesh {

/// Measures of the features of a shape, in the input's unit of length, squared or cubed.
struct ShapeMeasures {
  std::vector<double> volumes;  ///< by region; [0], the outside, is 0
  std::vector<double> areas;    ///< by patch
  std::vector<double> lengths;  ///< by curve
  std::vector<double> shells;   ///< volumes enclosed by closed surfaces, in the order of `shells_of`
};

/// A closed surface that bounds a region or the outside without being the whole boundary of one region: for
/// instance around a void, around one of several bodies of a region, or around several regions that touch.
struct Shell {
  Index region = none;  ///< the region that it bounds, 0: the outside
  std::vector<Index> patches;
};

/// Returns the connected parts of the boundaries of regions and of the outside, except those that are the
/// whole boundary of one region: its volume is measured anyway. Cost: near linear in the features.
std::vector<Shell> shells_of(const Plc& plc);

/// Measures the complex's triangles and polylines.
ShapeMeasures measures_of(const Plc& plc);

/// Returns the deviation of a measure of the mesh from the input's, in percent; NaN if the input has none.
inline double percent_off(double mesh, double input) { return 100 * (mesh - input) / input; }

/// Returns the largest relative deviation of a region's volume that elements of this order may have.
constexpr double volume_allowance(int order) { return order == 1 ? 0.05 : 0.01; }

/// The nodes of a triangle of second order: corners a, b, c, then the mid-edge nodes of ab, bc, ca.
using CurvedTriangle = std::array<Point, 6>;
/// The nodes of an edge of second order: its ends, then its mid-edge node.
using CurvedEdge = std::array<Point, 3>;

/// Returns the volume of a curved tet, exact except for rounding.
double volume(const CurvedTet& nodes);
/// Returns the signed volume of the curved tet between a triangle and a point, whose edges to the point are
/// straight; positive if the triangle's normal (b-a) x (c-a) points away from the point. The sum over a
/// closed surface is the volume that it encloses.
double volume_below(const Point& apex, const CurvedTriangle& nodes);
/// Returns the area of a curved triangle by quadrature of degree 4; exact if the triangle is straight.
double area(const CurvedTriangle& nodes);
/// Returns the length of a curved edge by quadrature of degree 5; exact if the edge is straight.
double length(const CurvedEdge& nodes);

}  // namespace collarmesh
