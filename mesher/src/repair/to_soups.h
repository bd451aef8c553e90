#pragma once

#include <span>
#include <vector>

#include "collarmesh/polygon_soup.h"
#include "facets/draft.h"

namespace collarmesh::repairing {

/// Turns a draft back into soups, with all data of the old soups besides facets. New edges, with a point at
/// or after `first_new_point`, become segments of soups that give their features, if their facets meet at an
/// angle.
std::vector<PolygonSoup> to_soups(std::span<const PolygonSoup> soups, const facets::Draft& draft,
                                  Index first_new_point);

}  // namespace collarmesh::repairing
