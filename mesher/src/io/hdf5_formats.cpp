// Loads the readers and writers that use HDF5 from a module when one is needed: HDF5 and MED bring some forty
// libraries, and loading these takes as long as meshing a small part.
#include <fmt/format.h>

#include "collarmesh/error.h"
#include "common/module_function.h"
#include "io/tet_mesh_formats.h"

namespace collarmesh::io {

namespace {

constexpr const char* module = "collarmesh_hdf5.so";

void write_by_module(const char* writer, const std::string& path, const TetMesh& mesh) {
  std::string reason;
  void* const found = module_function(module, writer, reason);
  if (found == nullptr)
    throw WriteError(fmt::format("{}: cannot be written, because {}, or write .vtu", path, reason));
  reinterpret_cast<void (*)(const std::string&, const TetMesh&)>(found)(path, mesh);
}

TetMesh read_by_module(const char* reader, const std::string& path) {
  std::string reason;
  void* const found = module_function(module, reader, reason);
  if (found == nullptr)
    throw ReadError(fmt::format("{}: cannot be read, because {}, or use another format", path, reason));
  TetMesh mesh;
  reinterpret_cast<void (*)(const std::string&, TetMesh&)>(found)(path, mesh);
  return mesh;
}

}  // namespace

TetMesh read_xdmf(const std::string& path) { return read_by_module("collarmesh_read_xdmf", path); }
TetMesh read_med(const std::string& path) { return read_by_module("collarmesh_read_med", path); }

void write_xdmf(const std::string& path, const TetMesh& mesh) {
  write_by_module("collarmesh_write_xdmf", path, mesh);
}

void write_cgns(const std::string& path, const TetMesh& mesh) {
  write_by_module("collarmesh_write_cgns", path, mesh);
}

void write_med(const std::string& path, const TetMesh& mesh) {
  write_by_module("collarmesh_write_med", path, mesh);
}

}  // namespace collarmesh::io
