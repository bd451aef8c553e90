// The writers on HDF5 are in a module of their own, which is loaded when one is used: HDF5 and MED bring
// some forty libraries, and loading those costs as much as a small mesh.
#include <dlfcn.h>
#include <fmt/format.h>

#include "collarmesh/error.h"
#include "io/tet_mesh_formats.h"

namespace collarmesh::io {

namespace {

void write_by_module(const char* writer, const std::string& path, const TetMesh& mesh) {
  constexpr const char* module = "collarmesh_hdf5.so";
  // Looked for along the run path of the program; stays loaded, as HDF5 has functions that run at its end.
  void* const loaded = dlopen(module, RTLD_NOW | RTLD_LOCAL);
  void* const found = loaded == nullptr ? nullptr : dlsym(loaded, writer);
  if (found == nullptr)
    throw WriteError(
        fmt::format("{}: cannot be written, because {} cannot be loaded ({}); install it with the "
                    "program or name its folder in LD_LIBRARY_PATH, or write .vtu",
                    path, module, dlerror()));
  reinterpret_cast<void (*)(const std::string&, const TetMesh&)>(found)(path, mesh);
}

}  // namespace

void write_xdmf(const std::string& path, const TetMesh& mesh) {
  write_by_module("collarmesh_write_xdmf", path, mesh);
}

void write_med(const std::string& path, const TetMesh& mesh) {
  write_by_module("collarmesh_write_med", path, mesh);
}

}  // namespace collarmesh::io
