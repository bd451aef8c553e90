#pragma once

#include "collarmesh/plc.h"
#include "collarmesh/tet_mesh.h"

namespace collarmesh::shells {

/// Turns the triangles of whole patches: faces of a region look out of it, those of an open surface like
/// their neighbours across edges of two triangles, as far as it is orientable; the first patch of each keeps
/// its orientation.
void turn_patches(TetMesh& mesh, const Plc& plc);

}  // namespace collarmesh::shells
