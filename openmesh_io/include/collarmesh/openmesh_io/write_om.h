#pragma once

#include <string>

#include "collarmesh/polygon_soup.h"

namespace collarmesh::openmesh_io {

/// Write a surface in OpenMesh's own format (.om), in doubles. Tags and segments have no place in it.
/// Throws WriteError: also for what OpenMesh cannot hold, namely facets with holes or of several
/// polygons, and edges of more than two faces.
void write_om(const std::string& path, const PolygonSoup& soup);

}  // namespace collarmesh::openmesh_io
