#pragma once

#include <string>

#include "collarmesh/tet_mesh.h"

namespace collarmesh::files {

/// Writes the partition of each tet, in their order, to a file that OpenFOAM's decomposePar reads (method
/// `manual`); gmshToFoam keeps the order. Throws WriteError.
void write_cell_decomposition(const std::string& path, const TetMesh& mesh);

}  // namespace collarmesh::files
