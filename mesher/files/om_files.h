#pragma once

#include <string>
#include <string_view>

#include "collarmesh/polygon_soup.h"

namespace collarmesh::files {

/// Returns whether the format is OpenMesh's own, by extension or name. False if the program was built without
/// OpenMesh.
bool is_om(const std::string& path, std::string_view format);

/// Read and write .om files by openmesh_io::read_om and write_om. These are in a module with OpenMesh, which
/// is loaded at the first call. Throw ReadError and WriteError, also if the module is missing.
PolygonSoup read_om(const std::string& path);
void write_om(const std::string& path, const PolygonSoup& soup);

}  // namespace collarmesh::files
