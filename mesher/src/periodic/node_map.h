#pragma once

#include <vector>

#include "collarmesh/periodic.h"
#include "collarmesh/tet_mesh.h"

namespace collarmesh::periodicity {

/// Fills in `PeriodicFaces::nodes` by places: of corners. Precondition: the faces of each pair are images of
/// each other.
void map_corners(TetMesh& mesh);

/// Adds mid-edge nodes to the map, and puts each node of the second faces exactly at its image, from where
/// exact geometry may have moved it a little. Completes the report. Called when the mesh is finished.
void finish_map(TetMesh& mesh, PeriodicReport& report);

}  // namespace collarmesh::periodicity
