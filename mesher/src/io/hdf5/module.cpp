// The functions that hdf5_formats.cpp loads from the module by name.
#include <hdf5.h>

#include "io/tet_mesh_formats.h"

namespace {

/// Keeps HDF5 from retrying, at the end of the program, to write files that could not be written, because the
/// attempt would crash. All other files are closed by then. The call works only before the first use of HDF5.
const herr_t no_work_at_the_end = H5dont_atexit();

}  // namespace

namespace collarmesh::io {

#pragma GCC visibility push(default)
extern "C" {

#ifdef COLLARMESH_XDMF
void collarmesh_write_xdmf(const std::string& path, const TetMesh& mesh) { write_xdmf(path, mesh); }
void collarmesh_read_xdmf(const std::string& path, TetMesh& mesh) { mesh = read_xdmf(path); }
void collarmesh_write_cgns(const std::string& path, const TetMesh& mesh) { write_cgns(path, mesh); }
#endif

#ifdef COLLARMESH_MED
void collarmesh_write_med(const std::string& path, const TetMesh& mesh) { write_med(path, mesh); }
void collarmesh_read_med(const std::string& path, TetMesh& mesh) { mesh = read_med(path); }
#endif
}
#pragma GCC visibility pop

}  // namespace collarmesh::io
