#pragma once

#include <utility>
#include <vector>

#include "facets/complex_draft.h"
#include "facets/faults.h"
#include "facets/simplices.h"

namespace collarmesh::facets {

/// Reports facets, loose segments and loose points that meet outside a common corner or edge as faults:
/// crossings, overlaps, and corners that lie on another facet or segment without being its corner. Cost: O(n
/// log n + k) for k pairs of near neighbours.
void find_intersections(const ComplexDraft& draft, const Simplices& simplices, Faults& faults);

/// Returns the pairs of simplices that `find_intersections` reports, as numbers in the list of simplices: the
/// smaller number first, sorted. Pairs of `settled` simplices (by number; empty: none) are known not to meet.
std::vector<std::pair<Index, Index>> intersecting_pairs(const ComplexDraft& draft, const Simplices& simplices,
                                                        const std::vector<bool>& settled = {});

}  // namespace collarmesh::facets
