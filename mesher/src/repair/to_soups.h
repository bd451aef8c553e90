#pragma once

#include <span>
#include <vector>

#include "collarmesh/polygon_soup.h"
#include "facets/complex_draft.h"

namespace collarmesh::repairing {

/// Turns a draft back into soups, with all data of the old soups except facets. If facets meet at an angle in
/// a new edge (with a point from `first_new_point` on), the edge becomes a segment, in soups with given
/// features.
std::vector<PolygonSoup> to_soups(std::span<const PolygonSoup> soups, const facets::ComplexDraft& draft,
                                  Index first_new_point);

}  // namespace collarmesh::repairing
