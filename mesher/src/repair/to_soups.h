#pragma once

#include <span>
#include <vector>

#include "collarmesh/polygon_soup.h"
#include "facets/complex_draft.h"

namespace collarmesh::repairing {

/// Turns a draft back into soups. Points, facets, segments and vertices come from the draft, all other data
/// from the old soups. In soups with given features, a new edge (with a point from `first_new_point` on) at
/// which facets end or meet sharply becomes a segment.
std::vector<PolygonSoup> to_soups(std::span<const PolygonSoup> soups, const facets::ComplexDraft& draft,
                                  Index first_new_point);

}  // namespace collarmesh::repairing
