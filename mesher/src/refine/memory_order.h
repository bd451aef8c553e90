#pragma once

#include "collarmesh/tet_mesh.h"

namespace collarmesh {

/// Number a mesh' points along a curve through space, and order its tets and faces by the least of their
/// points: then what is near in space is near in memory, whatever order refinement made it in. Coarsening,
/// improvement and the certificate take less time on such meshes, the more so the larger they are.
/// Precondition: the mesh is of first order. Cost: linear.
void order_in_memory(TetMesh& mesh);

}  // namespace collarmesh
