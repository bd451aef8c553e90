#pragma once

#include "collarmesh/plc.h"
#include "facets/faults.h"

namespace collarmesh::facets {

/// Adds a fault for each pair of features that come closer to each other than the limit (absolute) without
/// meeting in a common feature. Points within the limit would have been merged, so it is unclear whether the
/// features touch. Curves with the same ends are faults if they are within the limit of each other along
/// their whole length. Precondition: no two features cross. Cost: that of `find_intersections`.
void find_near_touching(const Plc& plc, double limit, Faults& faults);

}  // namespace collarmesh::facets
