#pragma once

#include <string>

#include "collarmesh/repair.h"

namespace collarmesh {

/// What a coarser repair of the same input loses beside a finer one, for messages; empty if nothing: a
/// region, unless it is small and thinner than the coarser tolerance, more than a little of a region's
/// volume, and facets, names or regions that the input gives a tag, but not the numbers of CAD faces.
std::string lost_parts(const Plc& finer, const RepairReport& finer_report, const Plc& coarser,
                       const RepairReport& coarser_report);

}  // namespace collarmesh
