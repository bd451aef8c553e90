#pragma once

#include <cstddef>
#include <vector>

#include "facets/complex_draft.h"

namespace collarmesh::repairing {

/// The result of `flatten_axis_planes`.
struct FlattenReport {
  std::size_t moved_points = 0;
  double largest_distance = 0;  ///< largest displacement of a point
  std::vector<Point> places;
};

/// Moves facets that are perpendicular to a coordinate axis, and nearer to each other than `tolerance`
/// (absolute) along it, onto one plane: the plane on which most of their area lies. Sheets that nearly
/// coincide meet in ever more places when their cuts are rounded; rounding moves nothing off an axis plane,
/// so sheets in such a plane are cut exactly. Facets count as perpendicular if they are flat within 1e-7 of
/// the diagonal. Points that the input gives as vertices stay, and so do soups that are at most twice as
/// thick as the tolerance. Cost: O(n log n).
FlattenReport flatten_axis_planes(facets::ComplexDraft& draft, double tolerance);

}  // namespace collarmesh::repairing
