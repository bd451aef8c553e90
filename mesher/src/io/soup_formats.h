#pragma once

#include <string>

#include "collarmesh/polygon_soup.h"

/// One reader and one writer per surface format. We have our own readers because errors must name a line or
/// byte, which no reader of CGAL::IO (5.5.1) does; each source lists what else CGAL does with bad files.
namespace collarmesh::io {

PolygonSoup read_off(const std::string& path);
PolygonSoup read_obj(const std::string& path);
PolygonSoup read_stl(const std::string& path);
PolygonSoup read_ply(const std::string& path);
/// TetGen's .poly and .smesh, which differ only in the facet list.
PolygonSoup read_poly(const std::string& path);
PolygonSoup read_smesh(const std::string& path);

void write_off(const std::string& path, const PolygonSoup& soup);
void write_obj(const std::string& path, const PolygonSoup& soup);
void write_stl(const std::string& path, const PolygonSoup& soup);
void write_ply(const std::string& path, const PolygonSoup& soup);
void write_poly(const std::string& path, const PolygonSoup& soup);
void write_smesh(const std::string& path, const PolygonSoup& soup);

}  // namespace collarmesh::io
