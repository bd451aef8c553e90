#pragma once

#include <string>
#include <string_view>

#include "collarmesh/polygon_soup.h"

namespace collarmesh::files {

/// Is this OpenMesh's own format, by the extension or the given one, and was the program built with OpenMesh?
bool is_om(const std::string& path, std::string_view format);

/// openmesh_io::read_om and write_om. OpenMesh comes with a module: loading the library takes as long as a
/// third of all others. Throw ReadError, WriteError, also where the module is not there.
PolygonSoup read_om(const std::string& path);
void write_om(const std::string& path, const PolygonSoup& soup);

}  // namespace collarmesh::files
