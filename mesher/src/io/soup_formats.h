#pragma once

#include <string>

#include "collarmesh/polygon_soup.h"

/// One reader and one writer per surface format. The readers are our own because errors have to name a line
/// or byte, which no reader of CGAL::IO (5.5.1) gives; what else it does with a bad file is said in each
/// source.
namespace collarmesh::io {

PolygonSoup read_off(const std::string& path);
PolygonSoup read_obj(const std::string& path);
PolygonSoup read_stl(const std::string& path);
PolygonSoup read_ply(const std::string& path);
/// TetGen's .poly and .smesh, which differ in the facet list only.
PolygonSoup read_poly(const std::string& path);
PolygonSoup read_smesh(const std::string& path);

void write_off(const std::string& path, const PolygonSoup& soup);
void write_obj(const std::string& path, const PolygonSoup& soup);
void write_stl(const std::string& path, const PolygonSoup& soup);
void write_ply(const std::string& path, const PolygonSoup& soup);
void write_poly(const std::string& path, const PolygonSoup& soup);
void write_smesh(const std::string& path, const PolygonSoup& soup);

}  // namespace collarmesh::io
