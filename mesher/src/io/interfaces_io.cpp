#include "collarmesh/io/interfaces_io.h"

#include <fmt/format.h>

#include "collarmesh/error.h"
#include "io/abaqus_interfaces.h"
#include "io/file_bytes.h"

namespace collarmesh::io {

namespace {

bool is_abaqus(const std::string& path, std::string_view format) { return format_of(path, format) == ".inp"; }

}  // namespace

void require_place_for_interfaces(const std::string& path, const SplitOptions& options,
                                  std::string_view format) {
  if ((options.interaction != Interaction::free || options.cohesive) && !is_abaqus(path, format))
    throw WriteError(
        fmt::format("{}: this format has no place for ties, contact pairs and cohesive elements; "
                    "write .inp, or leave out --interaction and --cohesive",
                    path));
}

void write_tet_mesh(const std::string& path, const TetMesh& mesh, const Interfaces& interfaces,
                    std::string_view format, GhostCells ghost_cells) {
  if (is_abaqus(path, format))
    write_abaqus(path, mesh, interfaces);
  else
    write_tet_mesh(path, mesh, format, ghost_cells);
}

}  // namespace collarmesh::io
