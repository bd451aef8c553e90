#pragma once

#include <string>

#include "collarmesh/polygon_soup.h"

namespace collarmesh::openmesh_io {

/// Writes a surface in OpenMesh's own format (.om), in double precision. The format cannot store tags and
/// segments. Throws WriteError, also for data that OpenMesh cannot represent: facets with holes or of several
/// polygons, and edges of more than two faces.
void write_om(const std::string& path, const PolygonSoup& soup);

}  // namespace collarmesh::openmesh_io
