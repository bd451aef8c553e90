#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "collarmesh/polygon_soup.h"

namespace collarmesh::io {

/// Reads a surface or PLC file by its extension (any case): .off .obj .stl .ply .poly .smesh, or as `format`
/// (one of those, lower case) says. Coordinates are doubles. Throws ReadError (path, line or byte) for a file
/// that is missing, malformed or truncated, and for counts that are too large for the file's size. .poly and
/// .smesh: the attribute of a region is its tag. Its volume constraint v becomes its target size: the edge
/// length of the regular tetrahedron of volume v, (6 sqrt 2 v)^(1/3).
PolygonSoup read_soup(const std::string& path, std::string_view format = {});

/// Writes a surface or PLC by the extension of `path`, or as `format` says. Only .poly holds facets of
/// several polygons or with holes, and only .poly and .smesh hold region and hole points; .stl holds
/// triangles with 32-bit coordinates. Cut facets with `merge_soups` first if the format cannot hold them.
/// Throws WriteError.
void write_soup(const std::string& path, const PolygonSoup& soup, std::string_view format = {});

/// Returns whether `read_soup` and `write_soup` know this extension or format.
bool is_soup_format(const std::string& path, std::string_view format = {});

/// Returns the extensions that `read_soup` and `write_soup` know.
std::vector<std::string> soup_formats();

}  // namespace collarmesh::io
