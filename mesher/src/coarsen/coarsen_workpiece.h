#pragma once

#include "collarmesh/coarsen.h"
#include "improve/workpiece.h"

namespace collarmesh {

/// Like `coarsen`, for a mesh that is improved next: does not write the workpiece back or mark thin tets, and
/// runs in the caller's arena.
CoarsenReport coarsen(improvement::Workpiece& workpiece, const MeshOptions& made_with,
                      const Execution& execution);

}  // namespace collarmesh
