#pragma once

#include <span>

#include "facets/draft.h"
#include "facets/faults.h"
#include "facets/weld.h"

namespace collarmesh::facets {

/// Cuts the soups' facets into triangles, and collect the segments and points they name. Triangles with two
/// equal corners are left out. A facet's triangulation is the constrained Delaunay one in the plane; what its
/// border, its holes' borders and hole points cut off is empty, as in TetGen. Faults: polygons that are not
/// planar, have no area, or whose edges cross.
void triangulate_facets(std::span<const PolygonSoup> soups, const PointMap& map, Draft& draft,
                        Faults& faults);

/// Counts of facets that `triangulate_any_facets` had to change.
struct BentFacets {
  Index split = 0;           ///< not planar, or with edges that cross: cut into triangles between its corners
  Index dropped = 0;         ///< without an area
  std::vector<Point> where;  ///< some of them
};

/// The same without faults: a polygon that is not planar is cut in the plane that fits it best, or from one
/// of its corners where its edges cross in that plane; one without an area is left out.
BentFacets triangulate_any_facets(std::span<const PolygonSoup> soups, const PointMap& map, Draft& draft);

}  // namespace collarmesh::facets
