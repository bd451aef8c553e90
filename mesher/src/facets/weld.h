#pragma once

#include <span>
#include <vector>

#include "facets/complex_draft.h"
#include "facets/faults.h"

namespace collarmesh::facets {

/// The new numbers of each soup's points.
struct PointMap {
  std::vector<std::vector<Index>> merged;  ///< by soup and point: its index in the draft, none if unused
};

/// Returns whether the soup is a piecewise-linear complex (.poly, .smesh, or one with region or hole points)
/// rather than a surface. In a complex the orientation of facets has no meaning, every bounded chamber
/// without a hole point is a region, and points that no facet uses are vertices.
bool is_complex(const PolygonSoup& soup);

/// Puts the used points of all soups into the draft. Merges points closer than `distance` (relative to the
/// diagonal of all points); chains of close points merge, too. Points that are merged get the place of the
/// first one among them. Sets the draft's bounds and deviation. Points that are not finite and corners out of
/// range become faults. Cost: O(n log n), unless many points are within `distance` of one plane that is
/// orthogonal to the direction of the sweep.
PointMap weld_points(std::span<const PolygonSoup> soups, double distance, ComplexDraft& draft,
                     Faults& faults);

}  // namespace collarmesh::facets
