#include "collarmesh/io/tet_mesh_io.h"

#include <fmt/format.h>

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "collarmesh/error.h"
#include "io/file_format.h"
#include "io/tet_mesh_formats.h"

namespace collarmesh::io {

namespace {

/// A format of meshes. A new one needs:
/// - a writer and, if it is read, a reader, each in a file of this folder, declared in tet_mesh_formats.h;
/// - FileWriter in the writer, or UnfinishedFile where a library writes, so that the file appears complete or
///   not at all;
/// - a line in `tet_mesh_formats`;
/// - a line in `meshes` in report/conversion_report.cpp, or `convert` reports no losses;
/// - if it writes or reads side files, a line each in `files_written`, `is_of_several_files` and `files_read`
///   in files/file_groups.cpp, so that no side file overwrites an input;
/// - a line in tests/fast/io_round_trip_test.cpp if it is read, else a case of
///   tests/io/solver_formats_test.py and its name in the list in tests/CMakeLists.txt;
/// - if it is read, its name in `formats` in tests/fuzz/CMakeLists.txt (write_seeds.cpp compares this list
///   with the readers'), and malformed files in tests/fast/io_hostile_test.cpp;
/// - if it is read and has a place for prisms, a line in `formats` in tests/fast/io_layers_test.cpp;
/// - its extension in the comment on `written_tet_mesh_formats` in include/collarmesh/io/tet_mesh_io.h;
/// - if its surface may be an input, a line in `mesh_formats` in mesh_surface_io.cpp;
/// - if it needs a library, an #ifdef around its line, and its name in `missing_library`;
/// - a line in `FORMATS` in freecad_workbench/freecad/collarmesh_workbench/mesh_file.py, if FreeCAD should
///   offer it;
/// - a row in doc/formats.md.
struct TetMeshFormat {
  std::string_view extension;
  void (*write)(const std::string& path, const TetMesh& mesh);
  TetMesh (*read)(const std::string& path);  ///< null: the format is only written
  bool partitions = false;                   ///< has a place for partitions
  void (*write_with_ghost_cells)(const std::string& path, const TetMesh& mesh) = nullptr;
  bool second_order = true;
  bool surfaces = false;    ///< can hold meshes of triangles alone and meshes of curve edges alone
  int order_of_layers = 0;  ///< the highest order of prisms and pyramids; 0: there is no place for them
};

constexpr TetMeshFormat of_surfaces(TetMeshFormat format) {
  format.surfaces = true;
  return format;
}

constexpr TetMeshFormat with_layers(TetMeshFormat format, int order = 2) {
  format.order_of_layers = order;
  return format;
}

constexpr std::array tet_mesh_formats{
    with_layers(of_surfaces(TetMeshFormat{".vtu", write_vtu, read_vtu, true})),
    TetMeshFormat{".pvtu", write_pvtu, read_pvtu, true, write_pvtu_with_ghost_cells},
    with_layers(of_surfaces(TetMeshFormat{".vtk", write_vtk, read_vtk, true})),
    with_layers(of_surfaces(TetMeshFormat{".msh", write_msh, read_msh, true, write_msh_with_ghost_cells})),
    with_layers(of_surfaces(TetMeshFormat{".msh2", write_msh2, read_msh, true})),
    with_layers(of_surfaces(TetMeshFormat{".mesh", write_medit, read_medit}), 1),
    with_layers(of_surfaces(TetMeshFormat{".inp", write_abaqus, read_abaqus})),
    with_layers(of_surfaces(TetMeshFormat{".unv", write_unv, read_unv})),
    TetMeshFormat{".ele", write_tetgen, read_tetgen},
    with_layers(TetMeshFormat{".bdf", write_nastran, nullptr}),
    with_layers(TetMeshFormat{".cdb", write_ansys, nullptr}),
    with_layers(TetMeshFormat{".mfem", write_mfem, nullptr}, 1),
    with_layers(TetMeshFormat{".exo", write_exodus, nullptr}),
    with_layers(TetMeshFormat{".su2", write_su2, nullptr, false, nullptr, false}, 1),
    with_layers(TetMeshFormat{".polymesh", write_openfoam, nullptr, false, nullptr, false}, 1),
#ifdef COLLARMESH_XDMF
    of_surfaces(TetMeshFormat{".xdmf", write_xdmf, read_xdmf, true}),
    with_layers(TetMeshFormat{".cgns", write_cgns, nullptr}),
#endif
#ifdef COLLARMESH_MED
    with_layers(of_surfaces(TetMeshFormat{".med", write_med, read_med, true})),
#endif
};

std::string unknown(const std::string& path, std::string_view format, const std::vector<std::string>& known) {
  const std::string missing = missing_library(path, format);
  return missing.empty()
             ? fmt::format("{}: unknown kind of file; tetrahedral meshes are {}", path, fmt::join(known, " "))
             : fmt::format("{}: {}", path, missing);
}

std::vector<std::string> extensions(bool (*wanted)(const TetMeshFormat&)) {
  std::vector<std::string> result;
  for (const TetMeshFormat& format : tet_mesh_formats)
    if (wanted(format)) result.emplace_back(format.extension);
  return result;
}

}  // namespace

namespace {

/// Rejects prisms and pyramids for which the format has no place.
void require_place_for_layers(const std::string& path, const TetMesh& mesh, const TetMeshFormat& format) {
  const LayerCells& layers = mesh.layers;
  if (layers.prisms.empty() && layers.pyramids.empty() && layers.quads.empty()) return;
  if (format.order_of_layers < mesh.order())
    throw WriteError(fmt::format("{}: {} has no place for prisms and pyramids{}; write {}", path,
                                 format.extension, format.order_of_layers > 0 ? " of second order" : "",
                                 fmt::join(formats_with_layers(mesh.order()), " ")));
  if (!mesh.tet_partition.empty())
    throw WriteError(
        path + ": a mesh with prisms or pyramids cannot be written in partitions; leave the partitions out");
}

}  // namespace

void write_tet_mesh(const std::string& path, const TetMesh& mesh, std::string_view format,
                    GhostCells ghost_cells) {
  const TetMeshFormat* found = find_format(tet_mesh_formats, path, format);
  if (found == nullptr) throw WriteError(unknown(path, format, written_tet_mesh_formats()));
  if ((mesh.is_surface() || mesh.is_curves()) && !found->surfaces)
    throw WriteError(fmt::format("{}: {} has no place for a mesh of {} alone; write {}", path,
                                 found->extension, mesh.is_curves() ? "lines" : "triangles",
                                 fmt::join(formats_of_surfaces(), " ")));
  require_place_for_layers(path, mesh, *found);
  const bool with_ghosts = ghost_cells == GhostCells::one_layer;
  if (with_ghosts && found->write_with_ghost_cells == nullptr)
    throw WriteError(
        fmt::format("{}: {} has no place for ghost cells; write .msh or .pvtu", path, found->extension));
  (with_ghosts ? found->write_with_ghost_cells : found->write)(path, mesh);
}

TetMesh read_tet_mesh(const std::string& path, std::string_view format) {
  const TetMeshFormat* found = find_format(tet_mesh_formats, path, format);
  if (found == nullptr || found->read == nullptr)
    throw ReadError(unknown(path, format, read_tet_mesh_formats()));
  return found->read(path);
}

std::vector<std::string> written_tet_mesh_formats() {
  return extensions([](const TetMeshFormat&) { return true; });
}

std::vector<std::string> formats_with_partitions() {
  return extensions([](const TetMeshFormat& format) { return format.partitions; });
}

std::vector<std::string> formats_of_first_order() {
  return extensions([](const TetMeshFormat& format) { return !format.second_order; });
}

std::vector<std::string> formats_of_surfaces() {
  return extensions([](const TetMeshFormat& format) { return format.surfaces; });
}

std::vector<std::string> formats_with_layers(int order) {
  return order == 2 ? extensions([](const TetMeshFormat& format) { return format.order_of_layers >= 2; })
                    : extensions([](const TetMeshFormat& format) { return format.order_of_layers >= 1; });
}

std::vector<std::string> formats_with_ghost_cells() {
  return extensions([](const TetMeshFormat& format) { return format.write_with_ghost_cells != nullptr; });
}

std::vector<std::string> read_tet_mesh_formats() {
  return extensions([](const TetMeshFormat& format) { return format.read != nullptr; });
}

std::string missing_library(const std::string& path, std::string_view format) {
  const std::string extension = format_of(path, format);
  const bool med = extension == ".med", hdf5 = extension == ".xdmf" || extension == ".cgns";
  if ((!med && !hdf5) || is_tet_mesh_format(path, format)) return {};
  return fmt::format(
      "{} needs {}, but this program was built without it; install {} and build the program again", extension,
      med ? "MED" : "HDF5", med ? "libmedc-dev and libhdf5-dev" : "libhdf5-dev");
}

bool is_tet_mesh_format(const std::string& path, std::string_view format) {
  return find_format(tet_mesh_formats, path, format) != nullptr;
}

}  // namespace collarmesh::io
