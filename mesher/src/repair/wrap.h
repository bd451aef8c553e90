#pragma once

#include <optional>
#include <span>

#include "collarmesh/plc_builder.h"
#include "collarmesh/repair.h"

namespace collarmesh::repairing {

/// A closed surface around all facets of the soups: free of intersections, orientable, at least `offset` and
/// about that far outside of them. It enters gaps and holes that are wider than about 2 `alpha`. Its facets are
/// triangles with tag 1.
/// `alpha` and `offset` are absolute, input units; `alpha` is to be 2 to 4 times `offset`.
/// Returns a soup without facets where there are no triangles to wrap.
/// Throws PlcError for points that are not finite and indices out of range.
/// Cost: O(n log n) for n triangles, and O(k log n) for the area of the result being some k alpha^2.
/// Portaneri, Rouxel-Labbe, Hemmer, Cohen-Steiner, Alliez 2022, by CGAL's Alpha_wrap_3.
PolygonSoup wrap(std::span<const PolygonSoup> soups, double alpha, double offset);

/// The largest distance of a surface of triangles from the facets of the soups, absolute: at corners, the midpoints
/// of edges and the centroids of triangles. How far facets inside the surface are from it does not count.
double largest_distance_from(std::span<const PolygonSoup> soups, const PolygonSoup& surface);

/// The complex of the surface that `wrap` makes with the offset of the options; nothing where that bounds none.
std::optional<RepairedPlc> build_wrapped_plc(std::span<const PolygonSoup> soups, const PlcOptions& options,
                                             const RepairOptions& repair_options);

}  // namespace collarmesh::repairing
