#pragma once

#include <span>
#include <vector>

#include "collarmesh/plc_builder.h"

namespace collarmesh::facets {

/// Returns the soups, followed by a box around them if the options ask for one. In a soup of points alone,
/// the points become features.
std::vector<PolygonSoup> with_box(std::span<const PolygonSoup> soups, const PlcOptions& options);

/// Returns the options for soups that include their box.
PlcOptions enclosed(PlcOptions options);

}  // namespace collarmesh::facets
