#pragma once

#include <optional>
#include <span>

#include "collarmesh/plc_builder.h"
#include "collarmesh/repair.h"

namespace collarmesh::repairing {

/// Returns a closed surface around all facets of the soups, made of triangles with tag 1: orientable, without
/// intersections. It lies outside of the facets: about `offset` away at its corners, mostly less than three
/// times `offset` elsewhere, and more where it spans a gap or a hole. It enters gaps and holes wider than
/// about 2 `alpha`. `alpha` and `offset` are absolute, input units; `alpha` should be 2 to 4 times `offset`.
/// If there is nothing to wrap, the result has no facets. Throws PlcError for points that are not finite and
/// indices out of range. Cost: O(n log n) for n triangles, and O(k log k) for a result of area k alpha^2.
/// Portaneri, Rouxel-Labbe, Hemmer, Cohen-Steiner, Alliez 2022, by CGAL's Alpha_wrap_3.
PolygonSoup wrap(std::span<const PolygonSoup> soups, double alpha, double offset);

/// Returns the largest distance of a surface of triangles from the facets of the soups, absolute, measured at
/// corners, midpoints of edges and centroids of the surface's triangles. The distance is one-sided: facets
/// may be farther from the surface.
double largest_distance_from(std::span<const PolygonSoup> soups, const PolygonSoup& surface);

/// Builds the complex of the surface that `wrap` makes with the offset of the options. Returns nothing if
/// that surface bounds no region.
std::optional<RepairedPlc> build_wrapped_plc(std::span<const PolygonSoup> soups, const PlcOptions& options,
                                             const RepairOptions& repair_options);

}  // namespace collarmesh::repairing
