#pragma once

#include <span>
#include <vector>

#include "collarmesh/plc_builder.h"

namespace collarmesh::facets {

/// Returns the soups and, last, the box around them that the options ask for. Points of a soup that has
/// nothing else are features then.
std::vector<PolygonSoup> with_box(std::span<const PolygonSoup> soups, const PlcOptions& options);

/// Returns the options for soups that have their box.
PlcOptions enclosed(PlcOptions options);

}  // namespace collarmesh::facets
