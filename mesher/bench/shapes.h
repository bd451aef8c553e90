#pragma once

#include <cstddef>
#include <vector>

#include "collarmesh/geometry.h"
#include "collarmesh/polygon_soup.h"

/// Generated inputs of the micro benchmarks.
namespace collarmesh::bench {

/// Returns about n well-spaced points in the unit cube, like the vertices of a mesh of uniform size: a
/// lattice whose points are moved at random by up to 0.4 of their spacing along each axis.
std::vector<Point> well_spaced_points(std::size_t n);

/// Returns n independent uniform points in the unit cube.
std::vector<Point> random_points(std::size_t n, unsigned seed);

/// Returns the same points, sorted along a space-filling curve.
std::vector<Point> spatially_sorted(const std::vector<Point>& points);

PolygonSoup unit_box();

/// Returns the unit sphere with `rings` circles of latitude of 2 * rings points: 4 * rings^2 triangles.
PolygonSoup sphere(Index rings);

}  // namespace collarmesh::bench
