#pragma once

#include <string>

#include "collarmesh/repair.h"

namespace collarmesh {

/// Returns a clause for messages about a part that a coarser repair loses and a finer one of the same input
/// keeps; empty if there is none. Parts are: tagged regions, tagged facets, and named patches and curves of
/// the input; regions whose volumes change by more than 2%, except small ones thinner than the coarser
/// tolerance. Numbers of CAD faces do not count as tags.
std::string lost_parts(const Plc& finer, const RepairReport& finer_report, const Plc& coarser,
                       const RepairReport& coarser_report);

}  // namespace collarmesh
