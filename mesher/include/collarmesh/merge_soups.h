#pragma once

#include <span>

#include "collarmesh/plc.h"
#include "collarmesh/polygon_soup.h"

namespace collarmesh {

/// Which facets `merge_soups` cuts into triangles.
enum class CutFacets {
  nothing,  ///< keep them: for formats of complexes
  complex,  ///< facets of several polygons or with holes, which most surface formats cannot hold
  all       ///< all facets with more than three corners
};

struct MergeSoupsOptions {
  double weld = 1e-9;  ///< relative to the bounding-box diagonal; points closer than this are merged
  CutFacets cut = CutFacets::nothing;
};

/// Counts of the changes that `merge_soups` made.
struct MergeReport {
  Index welded_points = 0;      ///< points merged with another one
  Index unused_points = 0;      ///< points dropped because nothing uses them; complexes keep such points
  Index cut_facets = 0;         ///< facets that became triangles
  Index degenerate_facets = 0;  ///< facets with fewer than three corners after welding: dropped
  Index repeated_facets = 0;    ///< duplicate facets, in either direction: dropped
};

/// Joins several soups without repairing them: reorients nothing, and leaves intersections and open borders.
/// Facets keep their order and tags; region points, hole points and holes of facets are kept. Throws PlcError
/// for points that are not finite, indices out of range, and facets to be cut that are not planar. Cost: O(n
/// log n) for n corners.
PolygonSoup merge_soups(std::span<const PolygonSoup> soups, const MergeSoupsOptions& options,
                        MergeReport& report);

/// Replaces the region and hole points of a soup by those of a complex that was built from it: one point
/// inside each region with its tag and size, one inside each cavity. A region too thin for a point in
/// floating-point numbers gets none. Returns the number of regions without a point. Cost: O(n log n) for n
/// triangles.
Index place_region_points(const Plc& plc, PolygonSoup& soup);

}  // namespace collarmesh
