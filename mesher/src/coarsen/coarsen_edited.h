#pragma once

#include "collarmesh/coarsen.h"
#include "remesh/editable_mesh.h"

namespace collarmesh {

/// Coarsens like the public `coarsen`, for callers that edit the mesh further: does not write the tets back
/// or mark thin tets, and runs in the caller's thread arena.
CoarsenReport coarsen(remeshing::EditableMesh& edited, const MeshOptions& made_with,
                      const Execution& execution);

}  // namespace collarmesh
