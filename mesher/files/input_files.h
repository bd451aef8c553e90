#pragma once

#include <optional>
#include <string>

#include "collarmesh/tet_mesh.h"

namespace collarmesh::files {

/// Returns the path to open for an input file; "-" is standard input. Throws ReadError; for a file that does
/// not exist, the message proposes the most similar name.
std::string existing_file(const std::string& path);

/// Reads a tetrahedral mesh. `format` overrides the file's extension. Throws ReadError.
TetMesh read_mesh(const std::string& path, const std::string& format = {});

/// Reads a tetrahedral mesh. Returns nothing if the file contains a surface instead, or has a surface format.
/// Throws ReadError.
std::optional<TetMesh> read_mesh_if_there(const std::string& path, const std::string& format = {});

/// Reads a tetrahedral mesh, or the triangles and lines of a file that has no tetrahedra. Throws ReadError.
TetMesh read_mesh_or_triangles(const std::string& path);

/// Returns the entry of the folder of `path` with the most similar name, or empty if none is similar.
std::string similar_file(const std::string& path);

}  // namespace collarmesh::files
