#pragma once

#include "collarmesh/coarsen.h"
#include "improve/workpiece.h"

namespace collarmesh {

/// As `coarsen`, of a mesh whose improvement comes next: the workpiece is not stored, thin tets are not
/// marked, and the threads are those of the arena that runs the caller.
CoarsenReport coarsen(improvement::Workpiece& workpiece, const MeshOptions& made_with,
                      const Execution& execution);

}  // namespace collarmesh
