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

/// The complex of some soups, for a judge that knows triangles alone: made of the soups by CGAL, by no code
/// of the mesher. Points closer than 1e-12 of the diagonal are one. The facets in one plane are triangulated
/// together, with all points and edges of the complex that lie in it: no triangle is there twice or overlaps
/// another one, and what meets a facet inside has its edges and corners there.
///
/// A segment that is no edge of a triangle is told by the places where it meets something else: from each
/// such end a triangle leads along half of it, a millionth of it wide. An end that nothing else touches is
/// not told, as no crease is there.
///
/// Throws std::exception on facets with holes, edges that cross, and flat triangles (corners within an edge).
TriangleComplex conforming_triangles(std::span<const PolygonSoup> soups);

/// Whether the triangles bound solids and nothing else: an even number at every edge.
bool is_closed(const TriangleComplex& complex);

}  // namespace collarmesh::testing
