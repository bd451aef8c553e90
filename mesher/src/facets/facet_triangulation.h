#pragma once

#include <span>

#include "facets/complex_draft.h"
#include "facets/faults.h"
#include "facets/weld.h"

namespace collarmesh::facets {

/// Cuts the soups' facets into triangles, and collects the segments and points that they give. Leaves out
/// triangles with two equal corners. A facet is triangulated by the constrained Delaunay triangulation in its
/// plane; the parts outside its border and around hole points are empty, as in TetGen. Faults: polygons that
/// are not planar, have no area, or whose edges cross.
void triangulate_facets(std::span<const PolygonSoup> soups, const PointMap& map, ComplexDraft& draft,
                        Faults& faults);

/// Counts of facets that `triangulate_any_facets` had to change.
struct BentFacets {
  Index split = 0;           ///< facets that are not planar or have crossing edges, cut into triangles
  Index dropped = 0;         ///< facets without area, left out
  std::vector<Point> where;  ///< places of some of them
};

/// Cuts facets into triangles without reporting faults. A polygon that is not planar is triangulated in its
/// projection along an axis. If its edges cross there, it becomes a fan of triangles from one of its corners.
/// Leaves out polygons without area.
BentFacets triangulate_any_facets(std::span<const PolygonSoup> soups, const PointMap& map,
                                  ComplexDraft& draft);

}  // namespace collarmesh::facets
