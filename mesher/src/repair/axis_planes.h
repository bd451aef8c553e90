#pragma once

#include <cstddef>
#include <vector>

#include "facets/complex_draft.h"

namespace collarmesh::repairing {

/// The result of `flatten_axis_planes`.
struct FlattenReport {
  std::size_t moved_points = 0;
  double largest_distance = 0;  ///< largest displacement of a point, absolute
  std::vector<Point> places;
};

/// Moves facets that are perpendicular to a coordinate axis, and nearer to each other than `tolerance`
/// (absolute) along it, onto one plane: the plane on which most of their area lies. Sheets that nearly
/// coincide meet in ever more places when their cuts are rounded; rounding moves nothing off an axis plane,
/// so sheets in such a plane are cut exactly. Facets count as perpendicular if they extend at most 1e-7 of
/// the diagonal along the axis, and their normal is within 26 degrees of it. Points that the input gives as
/// vertices stay, and so do soups that extend at most two tolerances along the axis. Cost: O(n log n).
FlattenReport flatten_axis_planes(facets::ComplexDraft& draft, double tolerance);

}  // namespace collarmesh::repairing
