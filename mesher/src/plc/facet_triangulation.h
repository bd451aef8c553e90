#pragma once

#include <span>

#include "plc/draft.h"
#include "plc/faults.h"
#include "plc/weld.h"

namespace collarmesh::build {

/// Cut the soups' facets into triangles, and collect the segments and points they name. Triangles
/// with two equal corners are left out. A facet's triangulation is the constrained Delaunay one in
/// the plane; what its border, its holes' borders and hole points cut off is empty, as in TetGen.
/// Faults: polygons that are not planar, have no area, or whose edges cross.
void triangulate_facets(std::span<const PolygonSoup> soups, const PointMap& map, Draft& draft,
                        Faults& faults);

}  // namespace collarmesh::build
