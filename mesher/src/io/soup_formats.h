#pragma once

#include <string>

#include "collarmesh/polygon_soup.h"

/// One reader per surface format. All are our own because errors have to name a line or byte, which
/// no reader of CGAL::IO (5.5.1) gives; what else it does with a bad file is said in each source.
namespace collarmesh::io {

PolygonSoup read_off(const std::string& path);
PolygonSoup read_obj(const std::string& path);
PolygonSoup read_stl(const std::string& path);
PolygonSoup read_ply(const std::string& path);
/// TetGen's .poly and .smesh, which differ in the facet list only.
PolygonSoup read_poly(const std::string& path);
PolygonSoup read_smesh(const std::string& path);

}  // namespace collarmesh::io
