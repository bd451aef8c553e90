#pragma once

#include "plc/draft.h"
#include "plc/edges.h"
#include "plc/faults.h"

namespace collarmesh::build {

/// Facets, loose segments and loose points that meet outside a common corner or edge become faults:
/// crossings, overlaps, and corners that lie on another facet or segment without being its corner.
/// Cost: O(n log n + k) for k pairs of near neighbours.
void find_intersections(const Draft& draft, const EdgeTable& edges, Faults& faults);

}  // namespace collarmesh::build
