#pragma once

#include "collarmesh/coarsen.h"
#include "remesh/editable_mesh.h"

namespace collarmesh {

/// Coarsens a mesh that is improved next, like `coarsen`, but does not write it back or mark thin tets, and
/// runs in the caller's arena.
CoarsenReport coarsen(remeshing::EditableMesh& edited, const MeshOptions& made_with,
                      const Execution& execution);

}  // namespace collarmesh
