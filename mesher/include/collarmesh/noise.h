#pragma once

#include "collarmesh/plc.h"
#include "collarmesh/repair.h"

namespace collarmesh {

/// Returns whether `remove_noise` would try to remove something from the complex. Cost: O(n log n + k) for n
/// triangles and segments, k pairs of which are near each other.
bool has_noise(const Plc& plc, const RepairOptions& options = {});

}  // namespace collarmesh
