// VTK's XML format for unstructured grids in pieces: NAME.pvtu lists a .vtu file for each partition,
// NAME_0.vtu and so on. Arrays give the numbers of points and cells in the whole mesh. Ghost cells, and
// points that another piece owns, are marked as in VTK (vtkDataSetAttributes: DUPLICATECELL, DUPLICATEPOINT).
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <iterator>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/sort_uniquely.h"
#include "common/xml_text.h"
#include "io/cell_nodes.h"
#include "io/cell_partitions.h"
#include "io/file_writer.h"
#include "io/tet_mesh_formats.h"
#include "io/vtk_grid.h"

namespace collarmesh::io {

namespace {

namespace fs = std::filesystem;

constexpr std::uint8_t duplicate = 1;

/// The cells and points of one piece. Its ghost tets follow its other tets.
struct Members {
  PerKind<std::vector<Index>> cells;
  std::vector<Index> points;
  std::size_t own_tets = 0;
};

/// Returns the cells of each partition; does not fill in the points.
std::vector<Members> members_by_partition(const TetMesh& mesh, const std::vector<Index>& numbers,
                                          bool with_ghosts) {
  std::vector<Members> members(numbers.size());
  const auto of = [&](Index partition) -> Members& {
    return members[static_cast<std::size_t>(std::lower_bound(numbers.begin(), numbers.end(), partition) -
                                            numbers.begin())];
  };
  const auto add = [&](CellKind kind, const std::vector<Index>& partitions) {
    for (Index i = 0; i < partitions.size(); ++i) of(partitions[i]).cells[kind].push_back(i);
  };
  add(CellKind::tet, mesh.tet_partition);
  add(CellKind::triangle, partitions_of_faces(mesh));
  add(CellKind::edge, partitions_of_edges(mesh));
  for (Members& each : members) each.own_tets = each.cells[CellKind::tet].size();
  if (!with_ghosts) return members;
  const std::vector<std::vector<Index>> ghosts = ghost_tets(mesh);
  for (std::size_t k = 0; k < members.size(); ++k)
    std::ranges::copy(ghosts[k], std::back_inserter(members[k].cells[CellKind::tet]));
  return members;
}

template <class T>
std::vector<T> picked(const std::vector<T>& values, const std::vector<Index>& which) {
  std::vector<T> result;
  if (values.empty()) return result;
  result.reserve(which.size());
  for (const Index i : which) result.push_back(values[i]);
  return result;
}

/// A tool that cuts pieces out of a mesh.
class Cutter {
 public:
  explicit Cutter(const TetMesh& mesh) : mesh_(mesh), local_(mesh.points.size(), none) {}

  /// Finds the points of the piece's cells, ascending. `first`: this is the first piece, which also gets the
  /// points without cells.
  void find_points(Members& members, bool first) const {
    std::vector<Index>& points = members.points;
    for (const CellKind kind : all_cell_kinds)
      for (const Index cell : members.cells[kind]) {
        const CellNodes nodes = nodes_of(kind)(mesh_, cell);
        points.insert(points.end(), nodes.begin(), nodes.end());
      }
    if (first) add_loose_points(points);
    sort_uniquely(points);
  }

  TetMesh cut(const Members& members) {
    for (std::size_t i = 0; i < members.points.size(); ++i) local_[members.points[i]] = static_cast<Index>(i);
    const std::vector<Index>& tets = members.cells[CellKind::tet];
    const std::vector<Index>& faces = members.cells[CellKind::triangle];
    const std::vector<Index>& edges = members.cells[CellKind::edge];
    TetMesh part;
    part.group_names = mesh_.group_names;
    part.names = mesh_.names;
    part.points = picked(mesh_.points, members.points);
    part.features = picked(mesh_.features, members.points);
    part.tets = numbered(picked(mesh_.tets, tets));
    part.tet_mid_nodes = numbered(picked(mesh_.tet_mid_nodes, tets));
    part.tet_region = picked(mesh_.tet_region, tets);
    part.tet_tag = picked(mesh_.tet_tag, tets);
    part.tet_collar = picked(mesh_.tet_collar, tets);
    part.tet_crease = picked(mesh_.tet_crease, tets);
    part.tet_thin = picked(mesh_.tet_thin, tets);
    part.tet_partition = picked(mesh_.tet_partition, tets);
    part.faces = numbered(picked(mesh_.faces, faces));
    part.face_mid_nodes = numbered(picked(mesh_.face_mid_nodes, faces));
    part.face_regions = picked(mesh_.face_regions, faces);
    part.face_patch = picked(mesh_.face_patch, faces);
    part.face_tag = picked(mesh_.face_tag, faces);
    part.edges = numbered(picked(mesh_.edges, edges));
    for (const Index node : picked(mesh_.edge_mid_nodes, edges)) part.edge_mid_nodes.push_back(local_[node]);
    part.edge_curve = picked(mesh_.edge_curve, edges);
    part.edge_tag = picked(mesh_.edge_tag, edges);
    return part;
  }

 private:
  template <std::size_t n>
  std::vector<std::array<Index, n>> numbered(std::vector<std::array<Index, n>> cells) const {
    for (auto& cell : cells)
      for (Index& v : cell) v = local_[v];
    return cells;
  }

  void add_loose_points(std::vector<Index>& points) const {
    std::vector<bool> used(mesh_.points.size(), false);
    for (const CellKind kind : all_cell_kinds)
      for (std::size_t i = 0; i < count_of(mesh_, kind); ++i)
        for (const Index v : nodes_of(kind)(mesh_, i)) used[v] = true;
    for (std::size_t v = 0; v < used.size(); ++v)
      if (!used[v]) points.push_back(static_cast<Index>(v));
  }

  const TetMesh& mesh_;
  std::vector<Index> local_;  // by point of the mesh: its index in the current piece
};

/// Returns the numbers of cells in the whole mesh, where tets come first, then faces, then edges.
VtkArray cell_ids(const TetMesh& mesh, const Members& members) {
  std::vector<std::int64_t> ids;
  for (const CellKind kind : all_cell_kinds) {
    const std::size_t before = count_before(mesh, kind);
    for (const Index cell : members.cells[kind]) ids.push_back(static_cast<std::int64_t>(before + cell));
  }
  return {std::string(vtk_cell_ids), std::move(ids)};
}

void add_ghost_marks(const Members& members, Index number, const std::vector<Index>& partition_of_point,
                     VtkGrid& grid) {
  std::vector<std::uint8_t> cells(grid.cell_count, 0), points;
  std::fill(cells.begin() + static_cast<std::ptrdiff_t>(members.own_tets),
            cells.begin() + static_cast<std::ptrdiff_t>(members.cells[CellKind::tet].size()), duplicate);
  for (const Index v : members.points) points.push_back(partition_of_point[v] == number ? 0 : duplicate);
  grid.cell_data.push_back({std::string(vtk_ghosts), std::move(cells)});
  grid.point_data.push_back({std::string(vtk_ghosts), std::move(points)});
}

void declare(FileWriter& out, std::string_view section, std::span<const VtkArray> arrays) {
  out << "    <P" << section;
  for (const VtkArray& array : arrays)
    if (array.name == vtk_point_ids || array.name == vtk_cell_ids)
      out << " GlobalIds=\"" << array.name << '"';
  out << ">\n";
  for (const VtkArray& array : arrays) {
    out << "      <PDataArray type=\"" << vtu_type(array) << "\" Name=\"" << array.name << '"';
    if (array.components > 1) out << " NumberOfComponents=\"" << array.components << '"';
    out << "/>\n";
  }
  out << "    </P" << section << ">\n";
}

/// Writes the .pvtu file. `like` is any one of the pieces, because all have the same arrays.
void write_list(const std::string& path, const VtkGrid& like, const std::vector<std::string>& pieces,
                bool with_ghosts) {
  FileWriter out(path);
  out << "<?xml version=\"1.0\"?>\n"
         "<VTKFile type=\"PUnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" "
         "header_type=\"UInt64\" compressor=\"vtkZLibDataCompressor\">\n  <PUnstructuredGrid GhostLevel=\""
      << (with_ghosts ? 1 : 0) << "\">\n";
  declare(out, "PointData", like.point_data);
  declare(out, "CellData", like.cell_data);
  declare(out, "Points", {&like.points, 1});
  for (const std::string& piece : pieces) out << "    <Piece Source=\"" << xml_text(piece) << "\"/>\n";
  out << "  </PUnstructuredGrid>\n</VTKFile>\n";
  out.commit();
}

/// Writes the pieces. `told`: whether the caller's mesh has partitions; they are then written as an array,
/// too.
void write_pieces(const std::string& path, const TetMesh& mesh, bool told, bool with_ghosts) {
  const std::vector<Index> numbers = partition_numbers(mesh), owners = partitions_of_points(mesh);
  std::vector<Members> members = members_by_partition(mesh, numbers, with_ghosts);
  Cutter cutter(mesh);
  VtkGrid grid;
  std::vector<std::string> names;
  for (std::size_t k = 0; k < members.size(); ++k) {
    cutter.find_points(members[k], k == 0);
    TetMesh part = cutter.cut(members[k]);
    if (!told) part.tet_partition.clear();
    grid = make_vtk_grid(part);
    grid.point_data.push_back(
        {std::string(vtk_point_ids),
         std::vector<std::int64_t>(members[k].points.begin(), members[k].points.end())});
    grid.cell_data.push_back(cell_ids(mesh, members[k]));
    if (with_ghosts) add_ghost_marks(members[k], numbers[k], owners, grid);
    const std::vector<VtkArray> boundary = take_boundary(part, grid);
    names.push_back(fmt::format("{}_{}.vtu", fs::path(path).stem().string(), numbers[k]));
    write_vtu_grid((fs::path(path).parent_path() / names.back()).string(), grid, boundary);
    members[k] = {};
  }
  write_list(path, grid, names, with_ghosts);  // last, so that its readers find all pieces
}

/// Writes the pieces; a mesh that is not partitioned is one piece.
void write_any(const std::string& path, const TetMesh& mesh, bool with_ghosts) {
  if (!mesh.tet_partition.empty()) {
    write_pieces(path, mesh, true, with_ghosts);
    return;
  }
  TetMesh whole = mesh;
  whole.tet_partition.assign(mesh.tets.size(), 0);
  write_pieces(path, whole, false, with_ghosts);
}

}  // namespace

void write_list_of_pieces(const std::string& path, const TetMesh& like,
                          const std::vector<std::string>& pieces) {
  write_list(path, make_vtk_grid(like), pieces, false);
}
void write_pvtu(const std::string& path, const TetMesh& mesh) { write_any(path, mesh, false); }
void write_pvtu_with_ghost_cells(const std::string& path, const TetMesh& mesh) {
  write_any(path, mesh, true);
}

}  // namespace collarmesh::io
