// The functions that programs look up by name when they load this module.
#include <string>

#include "collarmesh/openmesh_io/read_om.h"
#include "collarmesh/openmesh_io/write_om.h"

namespace collarmesh::openmesh_io {

#pragma GCC visibility push(default)
extern "C" {

void collarmesh_read_om(const std::string& path, PolygonSoup& soup) { soup = read_om(path); }
void collarmesh_write_om(const std::string& path, const PolygonSoup& soup) { write_om(path, soup); }
}
#pragma GCC visibility pop

}  // namespace collarmesh::openmesh_io
