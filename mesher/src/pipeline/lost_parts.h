#pragma once

#include <string>

#include "collarmesh/repair.h"

namespace collarmesh {

/// Describes the loss of a coarser repair of the same input compared with a finer one, for messages; empty if
/// there is none. It counts a region, unless it is small and thinner than the coarser tolerance, more than 2%
/// of a region's volume, and tagged facets, names and regions of the input, but not numbers of CAD faces.
std::string lost_parts(const Plc& finer, const RepairReport& finer_report, const Plc& coarser,
                       const RepairReport& coarser_report);

}  // namespace collarmesh
