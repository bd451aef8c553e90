#pragma once

#include "collarmesh/plc.h"
#include "collarmesh/tet_mesh.h"

namespace collarmesh::shells {

/// Turns patches over so that faces of a region point out of it, and patches of an open surface agree with
/// their neighbours across curves where two triangles meet, as far as the surface is orientable. The first
/// patch of each open surface keeps its orientation.
void turn_patches(TetMesh& mesh, const Plc& plc);

}  // namespace collarmesh::shells
