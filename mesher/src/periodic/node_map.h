#pragma once

#include <vector>

#include "collarmesh/periodic.h"
#include "collarmesh/tet_mesh.h"

namespace collarmesh::periodicity {

/// Fills in the corners in `PeriodicFaces::nodes`, by their places. Precondition: the faces of each pair are
/// images of each other.
void map_corners(TetMesh& mesh);

/// Adds mid-edge nodes to the map. Moves each node of the second faces exactly to the image of its partner on
/// the first faces, because projection onto exact geometry may have moved it slightly. Completes the report.
/// Call it when the mesh is finished.
void finish_map(TetMesh& mesh, PeriodicReport& report);

}  // namespace collarmesh::periodicity
