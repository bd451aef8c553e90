#pragma once

#include <string>
#include <vector>

#include "collarmesh/polygon_soup.h"
#include "collarmesh/tet_mesh.h"

namespace collarmesh::cli {

/// Read the files of one complex; "-" is standard input. `format` overrides the extensions.
/// Throws ReadError; for a file that does not exist it proposes the most similar name.
std::vector<PolygonSoup> read_soups(const std::vector<std::string>& paths, const std::string& format = {});

/// Read a tetrahedral mesh. Throws ReadError like `read_soups`.
TetMesh read_mesh(const std::string& path, const std::string& format = {});

/// The entry of the folder of `path` whose name is most like it, or empty when none is near.
std::string similar_file(const std::string& path);

}  // namespace collarmesh::cli
