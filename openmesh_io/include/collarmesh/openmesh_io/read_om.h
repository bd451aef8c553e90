#pragma once

#include <string>

#include "collarmesh/polygon_soup.h"

namespace collarmesh::openmesh_io {

/// Reads a mesh in OpenMesh's own format (.om), in doubles if it was saved in doubles. Faces marked as
/// deleted are left out; custom properties are not read. Throws ReadError (path, byte) for a file that is
/// missing, malformed or truncated, whose counts exceed what its size can hold, whose indices are out of
/// range or whose coordinates are not finite.
PolygonSoup read_om(const std::string& path);

}  // namespace collarmesh::openmesh_io
