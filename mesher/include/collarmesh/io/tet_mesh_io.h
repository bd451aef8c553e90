#pragma once

#include <string>

#include "collarmesh/tet_mesh.h"

namespace collarmesh::io {

/// Write a mesh by the extension of `path`: .vtu, .msh (Gmsh 4.1), .mesh (Medit). Written to a
/// temporary file beside it, then renamed: a reader never sees half a file.
/// Throws WriteError.
void write_tet_mesh(const std::string& path, const TetMesh& mesh);

/// Read what `write_tet_mesh` writes and, as far as they carry first-order tetrahedra, other programs' files of these formats.
/// Throws ReadError (path, line or byte).
TetMesh read_tet_mesh(const std::string& path);

/// Do `write_tet_mesh` and `read_tet_mesh` know this extension?
bool is_tet_mesh_format(const std::string& path);

}  // namespace collarmesh::io
