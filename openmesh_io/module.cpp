// The functions that programs look up by name when they load this module.
#include <string>

#include "collarmesh/openmesh_io/read_om.h"
#include "collarmesh/openmesh_io/write_om.h"

extern "C" {

__attribute__((visibility("default"))) void collarmesh_read_om(const std::string& path,
                                                               collarmesh::PolygonSoup& soup) {
  soup = collarmesh::openmesh_io::read_om(path);
}
__attribute__((visibility("default"))) void collarmesh_write_om(const std::string& path,
                                                                const collarmesh::PolygonSoup& soup) {
  collarmesh::openmesh_io::write_om(path, soup);
}
}
