#pragma once

#include <string>
#include <string_view>

#include "collarmesh/polygon_soup.h"
#include "collarmesh/tet_mesh.h"

namespace collarmesh::io {

/// Reads the tagged triangles, quadrangles and lines of a mesh file, with the names of their groups, as a
/// surface: .msh .mesh .vtu .vtp, by extension or as `format` says. Leaves out tetrahedra, but their tags
/// become the tags of the regions (`named_regions`). Leaves out mid-edge nodes, too. Throws ReadError.
PolygonSoup read_mesh_surface(const std::string& path, std::string_view format = {});

/// Reads the cells of a .msh, .mesh, .vtu or .vtp file as a mesh, with or without tetrahedra. Throws
/// ReadError.
TetMesh read_mesh_cells(const std::string& path, std::string_view format = {});

/// Returns whether `read_mesh_surface` knows this extension or format.
bool is_mesh_surface_format(const std::string& path, std::string_view format = {});

}  // namespace collarmesh::io
