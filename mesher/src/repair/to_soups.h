#pragma once

#include <span>
#include <vector>

#include "collarmesh/polygon_soup.h"
#include "facets/draft.h"

namespace collarmesh::repairing {

/// What a draft holds of each soup, as soups again, with all that the old ones say beside their facets. Edges
/// that arose, from points at or after `first_new_point`, become segments of soups that give their features,
/// where their facets meet at an angle.
std::vector<PolygonSoup> to_soups(std::span<const PolygonSoup> soups, const facets::Draft& draft,
                                  Index first_new_point);

}  // namespace collarmesh::repairing
