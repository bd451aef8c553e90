#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "collarmesh/polygon_soup.h"
#include "collarmesh/tet_mesh.h"

namespace collarmesh::files {

/// Returns whether a file has a format of io/soup_io.h or, if built with OpenMesh, .om. `format` overrides
/// the extension.
bool is_surface_format(const std::string& path, std::string_view format = {});
std::vector<std::string> surface_formats();

/// Reads a surface in one of the surface formats, or the tagged triangles of mesh files
/// (io/mesh_surface_io.h). Throws ReadError.
PolygonSoup read_surface(const std::string& path, std::string_view format = {});
/// Writes a surface. Throws WriteError.
void write_surface(const std::string& path, const PolygonSoup& soup, std::string_view format = {});

/// Returns the boundary and interface faces of a mesh with their tags, ordered by tag, because formats
/// without tags number patches in the order of the file. Throws ReadError if the mesh has no such triangles.
PolygonSoup surface_of(const TetMesh& mesh, const std::string& name);

}  // namespace collarmesh::files
