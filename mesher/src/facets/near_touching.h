#pragma once

#include "collarmesh/plc.h"
#include "facets/faults.h"

namespace collarmesh::facets {

/// Features without a common one must not come closer than the limit (absolute) to each other: closer
/// points would have been welded, so whether they touch cannot be told. Adds a fault for each pair.
/// Precondition: no two features cross. Cost: as that of finding intersections.
void find_near_touching(const Plc& plc, double limit, Faults& faults);

}  // namespace collarmesh::facets
