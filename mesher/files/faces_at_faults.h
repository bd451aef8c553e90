#pragma once

#include <set>
#include <span>
#include <utility>

#include "collarmesh/error.h"
#include "collarmesh/polygon_soup.h"

namespace collarmesh::files {

/// A soup and a tag, for its facets with this tag, such as those of one face of a CAD shape.
using SoupFace = std::pair<Index, Tag>;

/// Returns the faces with a facet at the place of a fault. Cost: facets times faults, of which PlcError holds
/// only the first ones of each kind.
std::set<SoupFace> faces_at(std::span<const PlcFault> faults, std::span<const PolygonSoup> soups);

}  // namespace collarmesh::files
