#pragma once

#include "collarmesh/plc.h"
#include "collarmesh/tet_mesh.h"

namespace collarmesh::shells {

/// Orients the triangles of whole patches. Faces of a region point out of it; faces of an open surface agree
/// with their neighbours across edges of two triangles, as far as the surface is orientable. The first patch
/// of each surface keeps its orientation.
void turn_patches(TetMesh& mesh, const Plc& plc);

}  // namespace collarmesh::shells
