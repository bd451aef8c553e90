#pragma once

#include <span>
#include <string>

#include "collarmesh/polygon_soup.h"

namespace collarmesh::io {

/// Returns the corners of a facet that is one polygon without a hole, as most surface formats require. Throws
/// WriteError (path, facet) for any other facet.
std::span<const Index> one_polygon(const std::string& path, const PolygonSoup& soup, Index facet);

}  // namespace collarmesh::io
