#pragma once

#include "collarmesh/improve.h"
#include "improve/workpiece.h"

namespace collarmesh {

/// As `improve`; the workpiece, which knows the distance, is not stored, and thin tets are not marked.
ImproveReport improve(improvement::Workpiece& workpiece, const ImproveOptions& options,
                      const Execution& execution);

}  // namespace collarmesh
