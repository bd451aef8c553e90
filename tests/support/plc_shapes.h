#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "collarmesh/plc.h"
#include "collarmesh/polygon_soup.h"

/// Shapes for tests of the complex. Facets of closed shapes have their normals outwards.
namespace collarmesh::testing {

/// Returns a box of six quadrangles.
PolygonSoup polygonal_box(const Point& min, const Point& max);
/// Returns a box whose sides are n x n squares of two triangles each.
PolygonSoup subdivided_box(const Point& min, const Point& max, Index n);
/// Returns a cylinder around the z axis: one layer of quadrangles between two polygons of n corners.
PolygonSoup polygonal_cylinder(Index n, double radius, double height);
/// Returns a cone: triangles from a regular n-gon in the plane z = 0 to an apex above its centre, closed by
/// the n-gon.
PolygonSoup polygonal_cone(Index n, double aperture_degrees, double height);
/// Returns a prism along the z axis over the triangle of two unit sides that form this angle at the origin.
PolygonSoup wedge(double angle_degrees, double length);
/// Returns a sphere: an octahedron with edges cut in n, its points moved onto the sphere around `centre`.
PolygonSoup sphere(Index n, double radius, const Point& centre);
/// Returns a band of n quadrangles, each cut in two, with a half twist.
PolygonSoup moebius_strip(Index n);

/// Returns the facets with their normals reversed.
PolygonSoup reversed(const PolygonSoup& soup);
/// Returns the soup without one facet.
PolygonSoup without_facet(const PolygonSoup& soup, Index facet);
/// Returns all soups in one, with points not merged.
PolygonSoup joined(const std::vector<PolygonSoup>& soups);
/// Returns the soup with separate points for each facet, as in an .stl file.
PolygonSoup torn_apart(const PolygonSoup& soup);
/// Returns the soup with points, facets and first corners in another order; if `turn`, some facets are
/// reversed.
PolygonSoup shuffled(const PolygonSoup& soup, std::uint64_t seed, bool turn);
/// Returns the soup turned by a random rotation, scaled and moved.
PolygonSoup moved(const PolygonSoup& soup, std::uint64_t seed, double scale, double offset);

/// Returns the faults of the complex: incidence lists that are not mutual, patches that are no oriented
/// manifolds, regions whose borders do not close, curves that are no chains of edges of their patches.
std::vector<std::string> findings(const Plc& plc);

}  // namespace collarmesh::testing
