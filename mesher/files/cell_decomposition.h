#pragma once

#include <string>

#include "collarmesh/tet_mesh.h"

namespace collarmesh::files {

/// Writes the partition of each tet, in the order of the tets, to a file that OpenFOAM's decomposePar reads
/// (method `manual`). OpenFOAM's gmshToFoam keeps the order of tets. Throws WriteError.
void write_cell_decomposition(const std::string& path, const TetMesh& mesh);

}  // namespace collarmesh::files
