#pragma once

#include <span>
#include <vector>

#include "collarmesh/plc_builder.h"

namespace collarmesh::facets {

/// Returns the soups, followed by a box around all their points unless there are none. In a soup of points
/// alone, the points become vertices.
std::vector<PolygonSoup> with_box(std::span<const PolygonSoup> soups, const PlcOptions& options);

/// Returns the options for soups that already include their box.
PlcOptions enclosed(PlcOptions options);

}  // namespace collarmesh::facets
