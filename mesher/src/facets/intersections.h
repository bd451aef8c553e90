#pragma once

#include <utility>
#include <vector>

#include "facets/draft.h"
#include "facets/faults.h"
#include "facets/simplices.h"

namespace collarmesh::facets {

/// Facets, loose segments and loose points that meet outside a common corner or edge become faults:
/// crossings, overlaps, and corners that lie on another facet or segment without being its corner.
/// Cost: O(n log n + k) for k pairs of near neighbours.
void find_intersections(const Draft& draft, const Simplices& simplices, Faults& faults);

/// The same pairs, as numbers in the list of simplices, smaller ones first, in order. Pairs of `settled`
/// simplices (by number; empty: none are) are known not to meet.
std::vector<std::pair<Index, Index>> intersecting_pairs(const Draft& draft, const Simplices& simplices,
                                                        const std::vector<bool>& settled = {});

}  // namespace collarmesh::facets
