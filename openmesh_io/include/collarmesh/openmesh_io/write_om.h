#pragma once

#include <string>

#include "collarmesh/polygon_soup.h"

namespace collarmesh::openmesh_io {

/// Writes a surface in OpenMesh's own format (.om), in double precision. The format cannot store tags and
/// segments. Throws WriteError if writing fails, and for data that OpenMesh cannot represent: facets with
/// holes, several polygons or a repeated corner, edges of more than two faces, and neighbouring faces that
/// are oriented inconsistently.
void write_om(const std::string& path, const PolygonSoup& soup);

}  // namespace collarmesh::openmesh_io
