#pragma once

#include "collarmesh/improve.h"
#include "improve/workpiece.h"

namespace collarmesh {

/// As `improve`; the workpiece, which knows the distance, is not stored, thin tets are not marked, and
/// the threads are those of the arena that runs the caller.
ImproveReport improve(improvement::Workpiece& workpiece, const ImproveOptions& options,
                      const Execution& execution);

}  // namespace collarmesh
