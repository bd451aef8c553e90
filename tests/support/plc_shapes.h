#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "collarmesh/plc.h"
#include "collarmesh/polygon_soup.h"

/// Shapes for the tests of the complex. Closed ones have their facets' normals outwards.
namespace collarmesh::testing {

/// Six quadrangles.
PolygonSoup box(const Point& min, const Point& max);
/// A box whose sides are n x n squares of two triangles each.
PolygonSoup subdivided_box(const Point& min, const Point& max, Index n);
/// Around the z axis, one layer of quadrangles between two polygons of n corners.
PolygonSoup cylinder(Index n, double radius, double height);
/// Triangles from a regular n-gon in the plane z = 0 to an apex above its centre; closed by the n-gon.
PolygonSoup cone(Index n, double aperture_degrees, double height);
/// A prism along the z axis over the triangle of two unit sides that enclose this angle at the origin.
PolygonSoup wedge(double angle_degrees, double length);
/// Octahedron with sides cut in n, its points moved onto the unit sphere around `centre`.
PolygonSoup sphere(Index n, double radius, const Point& centre);
/// A band of n quadrangles, each cut in two, with a half twist.
PolygonSoup moebius_strip(Index n);

/// The same facets with their normals turned round.
PolygonSoup reversed(const PolygonSoup& soup);
/// Without one facet.
PolygonSoup without_facet(const PolygonSoup& soup, Index facet);
/// All in one soup, points not merged.
PolygonSoup joined(const std::vector<PolygonSoup>& soups);
/// Every facet's points copied, as in an .stl file.
PolygonSoup torn_apart(const PolygonSoup& soup);
/// Points, facets and first corners in another order, some facets turned round if `turn`.
PolygonSoup shuffled(const PolygonSoup& soup, std::uint64_t seed, bool turn);
/// Turned by a random rotation, scaled and moved.
PolygonSoup moved(const PolygonSoup& soup, std::uint64_t seed, double scale, double offset);

/// What is wrong with the complex: incidence lists that are not mutual, patches that are no oriented
/// manifolds, regions whose borders do not close, curves that are no chains of edges of their patches.
std::vector<std::string> findings(const Plc& plc);

}  // namespace collarmesh::testing
