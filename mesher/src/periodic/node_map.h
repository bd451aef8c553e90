#pragma once

#include <vector>

#include "collarmesh/periodic.h"
#include "collarmesh/tet_mesh.h"

namespace collarmesh::periodicity {

/// Puts each node of the second faces exactly at the image of the first's, if no tet loses its volume, and
/// fills in `PeriodicFaces::nodes`, mid-edge nodes included. Completes the report. Called when the mesh is
/// finished. Cost: n log n in the nodes of these faces.
void map_nodes(TetMesh& mesh, PeriodicReport& report);

}  // namespace collarmesh::periodicity
