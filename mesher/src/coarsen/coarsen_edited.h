#pragma once

#include "collarmesh/coarsen.h"
#include "remesh/editable_mesh.h"

namespace collarmesh {

/// Like `coarsen`, for a mesh that is improved next: does not write the mesh back or mark thin tets, and
/// runs in the caller's arena.
CoarsenReport coarsen(remeshing::EditableMesh& edited, const MeshOptions& made_with,
                      const Execution& execution);

}  // namespace collarmesh
