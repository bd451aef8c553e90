#pragma once

#include <set>
#include <span>
#include <utility>

#include "collarmesh/error.h"
#include "collarmesh/polygon_soup.h"

namespace collarmesh::files {

/// A face of a CAD shape: the soup of its triangles and their tag.
using SoupFace = std::pair<Index, Tag>;

/// Returns the faces with a facet at the place of a fault.
std::set<SoupFace> faces_at(std::span<const PlcFault> faults, std::span<const PolygonSoup> soups);

}  // namespace collarmesh::files
