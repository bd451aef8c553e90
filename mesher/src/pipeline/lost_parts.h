#pragma once

#include <string>

#include "collarmesh/repair.h"

namespace collarmesh {

/// Describes the parts that a coarser repair loses, compared with a finer one of the same input, for
/// messages; empty if it loses none. Parts are: regions, except small ones thinner than the coarser
/// tolerance; more than 2% of a region's volume; tagged facets, names and regions of the input. Numbers of
/// CAD faces do not count.
std::string lost_parts(const Plc& finer, const RepairReport& finer_report, const Plc& coarser,
                       const RepairReport& coarser_report);

}  // namespace collarmesh
