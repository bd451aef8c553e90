#pragma once

#include <array>
#include <span>
#include <vector>

#include "collarmesh/polygon_soup.h"

namespace collarmesh::testing {

/// A complex of triangles that share whole edges and corners.
struct TriangleComplex {
  std::vector<Point> points;
  std::vector<std::array<Index, 3>> triangles;  ///< oriented like their facets
};

/// Makes a complex of triangles from some soups, for a judge that only knows triangles. It uses CGAL and no
/// code of the mesher. Merges points closer than 1e-12 of the diagonal. Triangulates the facets in one plane
/// together, with all points and edges of the complex in it: no triangle occurs twice or overlaps another
/// one, and features that meet a facet inside have edges and corners there.
/// A segment that is no edge of a triangle is represented only where it meets other features: from each such
/// end a triangle leads along half of the segment, with a width of a millionth of it. Ends that nothing else
/// touches are left out, as there is no crease.
/// Throws std::exception on facets with holes, edges that cross, and flat triangles (with a corner on an
/// edge).
TriangleComplex conforming_triangles(std::span<const PolygonSoup> soups);

/// Returns whether all triangles bound solids: whether every edge has an even number of them.
bool is_closed(const TriangleComplex& complex);

}  // namespace collarmesh::testing
