#pragma once

#include <span>
#include <string>

#include "collarmesh/polygon_soup.h"

namespace collarmesh::io {

/// The corners of a facet that is one polygon without a hole: what most surface formats can hold.
/// Throws WriteError (path, facet) for another one.
std::span<const Index> one_polygon(const std::string& path, const PolygonSoup& soup, Index facet);

}  // namespace collarmesh::io
