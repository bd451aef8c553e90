#pragma once

#include <string>

#include "collarmesh/polygon_soup.h"

namespace collarmesh::openmesh_io {

/// Reads a mesh in OpenMesh's own format (.om), in double precision if it was saved so. Leaves out custom
/// properties, and faces that are marked as deleted. Throws ReadError (path, byte) for a file that is
/// missing, malformed or truncated, whose counts are too large for its size, whose indices are out of range,
/// or whose coordinates are not finite.
PolygonSoup read_om(const std::string& path);

}  // namespace collarmesh::openmesh_io
