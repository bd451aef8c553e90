// The functions that hdf5_formats.cpp loads from the module by name.
#include <hdf5.h>

#include "io/tet_mesh_formats.h"

namespace {

/// By the end of the program all files are closed, or could not be written. HDF5 would try again to write the
/// latter and crash. Works only before the first use of HDF5.
const herr_t no_work_at_the_end = H5dont_atexit();

}  // namespace

extern "C" {

#ifdef COLLARMESH_XDMF
__attribute__((visibility("default"))) void collarmesh_write_xdmf(const std::string& path,
                                                                  const collarmesh::TetMesh& mesh) {
  collarmesh::io::write_xdmf(path, mesh);
}
__attribute__((visibility("default"))) void collarmesh_read_xdmf(const std::string& path,
                                                                 collarmesh::TetMesh& mesh) {
  mesh = collarmesh::io::read_xdmf(path);
}
__attribute__((visibility("default"))) void collarmesh_write_cgns(const std::string& path,
                                                                  const collarmesh::TetMesh& mesh) {
  collarmesh::io::write_cgns(path, mesh);
}
#endif

#ifdef COLLARMESH_MED
__attribute__((visibility("default"))) void collarmesh_write_med(const std::string& path,
                                                                 const collarmesh::TetMesh& mesh) {
  collarmesh::io::write_med(path, mesh);
}
__attribute__((visibility("default"))) void collarmesh_read_med(const std::string& path,
                                                                collarmesh::TetMesh& mesh) {
  mesh = collarmesh::io::read_med(path);
}
#endif
}
