#pragma once

#include <span>
#include <vector>

#include "facets/draft.h"
#include "facets/faults.h"

namespace collarmesh::facets {

/// The new numbers of each soup's points.
struct PointMap {
  std::vector<std::vector<Index>> merged;  ///< by soup and point: its index in the draft, none if unused
};

/// Is the soup a piecewise-linear complex (.poly, .smesh, or one with region or hole points) rather
/// than a surface? Then the orientation of its facets means nothing, every bounded chamber without a
/// hole point is a region, and points that no facet uses are vertices.
bool is_complex(const PolygonSoup& soup);

/// Puts the used points of all soups into the draft, those closer than `distance` (relative to the diagonal
/// of them all) as one; chains of close points merge too. A merged point lies where the first of its points
/// did. Sets the bounds and the draft's deviation. Points that are not finite and corners out of range become
/// faults. Cost: O(n log n) unless many points lie within `distance` of one plane.
PointMap weld_points(std::span<const PolygonSoup> soups, double distance, Draft& draft, Faults& faults);

}  // namespace collarmesh::facets
