#include "collarmesh/io/tet_mesh_io.h"

#include <fmt/format.h>

#include <array>
#include <string_view>

#include "collarmesh/error.h"
#include "io/file_bytes.h"
#include "io/tet_mesh_formats.h"

namespace collarmesh::io {

namespace {

struct TetMeshFormat {
  std::string_view extension;
  void (*write)(const std::string& path, const TetMesh& mesh);
  TetMesh (*read)(const std::string& path);
};

constexpr std::array<TetMeshFormat, 3> tet_mesh_formats{
    {{".vtu", write_vtu, read_vtu}, {".msh", write_msh, read_msh}, {".mesh", write_medit, read_medit}}};

constexpr std::string_view known = "tetrahedral meshes are .vtu, .msh (Gmsh) and .mesh (Medit)";

const TetMeshFormat* find_format(const std::string& path) {
  const std::string extension = lower_extension(path);
  for (const TetMeshFormat& format : tet_mesh_formats)
    if (format.extension == extension) return &format;
  return nullptr;
}

}  // namespace

void write_tet_mesh(const std::string& path, const TetMesh& mesh) {
  const TetMeshFormat* format = find_format(path);
  if (format == nullptr) throw WriteError(fmt::format("{}: unknown kind of file; {}", path, known));
  format->write(path, mesh);
}

TetMesh read_tet_mesh(const std::string& path) {
  const TetMeshFormat* format = find_format(path);
  if (format == nullptr) throw ReadError(fmt::format("{}: unknown kind of file; {}", path, known));
  return format->read(path);
}

bool is_tet_mesh_format(const std::string& path) { return find_format(path) != nullptr; }

}  // namespace collarmesh::io
