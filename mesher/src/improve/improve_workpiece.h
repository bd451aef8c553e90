#pragma once

#include "collarmesh/improve.h"
#include "improve/workpiece.h"

namespace collarmesh {

/// Like `improve`, but works on the caller's workpiece: does not write the mesh back or mark thin tets, and
/// runs in the caller's arena. `thoroughly`: take detours and fill cavities again, which is slow where many
/// tets stay poor.
ImproveReport improve(improvement::Workpiece& workpiece, const ImproveOptions& options,
                      const Execution& execution, bool thoroughly = true);

}  // namespace collarmesh
