#pragma once

#include <string>

#include "collarmesh/polygon_soup.h"

namespace collarmesh::io {

/// Read a surface or PLC file by its extension (any case): .off .obj .stl .ply .poly .smesh.
/// Coordinates are doubles. Throws ReadError (path, line or byte) for a file that is missing,
/// malformed, truncated or whose counts exceed what its size can hold.
PolygonSoup read_soup(const std::string& path);

/// Does `read_soup` know this extension?
bool is_soup_format(const std::string& path);

}  // namespace collarmesh::io
