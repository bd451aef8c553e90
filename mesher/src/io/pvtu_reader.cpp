// Reads VTK's XML format for unstructured grids in pieces, and joins the pieces by the numbers that their
// points and cells have in the whole mesh. Ghost cells are skipped, because another piece has them.
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <pugixml.hpp>
#include <set>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "collarmesh/error.h"
#include "io/file_bytes.h"
#include "io/tet_mesh_formats.h"
#include "io/vtk_grid.h"

namespace collarmesh::io {

namespace {

namespace fs = std::filesystem;

/// A piece and its file.
struct NamedPiece {
  std::string path;
  VtkPiece piece;
  std::vector<std::int64_t> point_of;  ///< index of each of its points in the whole mesh
};

const std::vector<std::int64_t>& numbers(const NamedPiece& named, const VtkPiece::Arrays& arrays,
                                         std::string_view name, std::size_t count) {
  static const std::vector<std::int64_t> nothing;
  const auto found = arrays.find(name);
  if (found != arrays.end() && found->second.size() == count) return found->second;
  if (count == 0) return nothing;
  throw ReadError(
      fmt::format("{}: expected an array '{}', by which the pieces are put together; save the pieces with "
                  "numbers of points and cells, or use them one by one",
                  named.path, name));
}

/// A point or a cell: its number in the whole mesh, its piece, and its index there.
struct PieceMember {
  std::int64_t number;
  std::size_t piece, index;
};

void sort_by_number(std::vector<PieceMember>& members) {
  std::sort(members.begin(), members.end(), [](const PieceMember& a, const PieceMember& b) {
    return std::tie(a.number, a.piece, a.index) < std::tie(b.number, b.piece, b.index);
  });
}

/// Joins the arrays that have one of these names and exist in all pieces. Leaves out numbers in the whole
/// mesh and marks of ghosts.
template <std::size_t count>
void join_arrays(const std::vector<NamedPiece>& pieces, const std::vector<PieceMember>& members,
                 const std::array<std::string_view, count>& names, VtkPiece::Arrays VtkPiece::*arrays,
                 VtkPiece& whole) {
  for (const std::string_view name : names) {
    const bool everywhere = std::all_of(pieces.begin(), pieces.end(), [&](const NamedPiece& each) {
      return (each.piece.*arrays).contains(name);
    });
    if (!everywhere || name == vtk_point_ids || name == vtk_cell_ids || name == vtk_ghosts) continue;
    auto& values = (whole.*arrays)[std::string(name)];
    for (const PieceMember& member : members)
      values.push_back((pieces[member.piece].piece.*arrays).find(name)->second[member.index]);
  }
}

/// Joins points in the order of their numbers. Points with one number become one point.
void join_points(std::vector<NamedPiece>& pieces, VtkPiece& whole) {
  std::vector<PieceMember> members;
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    const VtkPiece& piece = pieces[k].piece;
    const auto& ids = numbers(pieces[k], piece.point_data, vtk_point_ids, piece.points.size());
    for (std::size_t i = 0; i < ids.size(); ++i) members.push_back({ids[i], k, i});
    pieces[k].point_of.resize(piece.points.size());
  }
  sort_by_number(members);
  std::vector<PieceMember> kept;
  for (const PieceMember& member : members) {
    const Point& p = pieces[member.piece].piece.points[member.index];
    if (kept.empty() || kept.back().number != member.number) {
      kept.push_back(member);
      whole.points.push_back(p);
    } else if (p != whole.points.back()) {
      throw ReadError(fmt::format(
          "{}: point {} is at ({}, {}, {}), but in another piece at ({}, {}, {}); save all pieces again",
          pieces[member.piece].path, member.number, p.x, p.y, p.z, whole.points.back().x,
          whole.points.back().y, whole.points.back().z));
    }
    pieces[member.piece].point_of[member.index] = static_cast<std::int64_t>(whole.points.size()) - 1;
  }
  join_arrays(pieces, kept, vtk_point_arrays, &VtkPiece::point_data, whole);
}

/// Joins cells in the order of their numbers.
void join_cells(const std::vector<NamedPiece>& pieces, VtkPiece& whole) {
  std::vector<PieceMember> members;
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    const VtkPiece& piece = pieces[k].piece;
    const auto& ids = numbers(pieces[k], piece.cell_data, vtk_cell_ids, piece.types.size());
    const auto ghosts = piece.cell_data.find(vtk_ghosts);
    for (std::size_t i = 0; i < ids.size(); ++i)
      if (ghosts == piece.cell_data.end() || ghosts->second[i] == 0) members.push_back({ids[i], k, i});
  }
  sort_by_number(members);
  for (std::size_t i = 1; i < members.size(); ++i)
    if (members[i].number == members[i - 1].number)
      throw ReadError(
          fmt::format("{}: cell {} occurs twice, and neither copy is marked as a ghost; mark one in the "
                      "array vtkGhostType",
                      pieces[members[i].piece].path, members[i].number));
  for (const PieceMember& member : members) {
    const auto& [path, piece, point_of] = pieces[member.piece];
    const auto size = static_cast<std::int64_t>(piece.connectivity.size());
    const std::int64_t begin = member.index == 0 ? 0 : piece.ends[member.index - 1],
                       end = piece.ends[member.index];
    if (begin < 0 || end < begin || end > size)
      throw ReadError(fmt::format("{}: the connectivity of cell {} goes from {} to {}, of {} entries", path,
                                  member.index, begin, end, size));
    for (std::int64_t at = begin; at < end; ++at) {
      const std::int64_t corner = piece.connectivity[static_cast<std::size_t>(at)];
      if (corner < 0 || corner >= static_cast<std::int64_t>(point_of.size()))
        throw ReadError(fmt::format("{}: cell {} has the corner {}, but there are {} points", path,
                                    member.index, corner, point_of.size()));
      whole.connectivity.push_back(point_of[static_cast<std::size_t>(corner)]);
    }
    whole.ends.push_back(static_cast<std::int64_t>(whole.connectivity.size()));
    whole.types.push_back(piece.types[member.index]);
  }
  join_arrays(pieces, members, vtk_cell_arrays, &VtkPiece::cell_data, whole);
}

}  // namespace

std::vector<std::string> pieces_of_pvtu(const std::string& path) {
  const std::string text = read_bytes(path);
  pugi::xml_document document;
  const pugi::xml_parse_result parsed = document.load_buffer(text.data(), text.size());
  if (!parsed)
    throw ReadError(
        fmt::format("{}: byte {}: the XML is malformed: {}", path, parsed.offset, parsed.description()));
  const pugi::xml_node grid = document.child("VTKFile").child("PUnstructuredGrid");
  if (!grid) throw ReadError(path + ": expected a VTKFile with a PUnstructuredGrid");
  std::vector<std::string> files;
  std::set<std::string> known;
  for (const pugi::xml_node& piece : grid.children("Piece")) {
    const std::string source = piece.attribute("Source").value();
    if (source.empty()) throw ReadError(path + ": a Piece has no Source");
    std::string file = (fs::path(path).parent_path() / source).string();
    if (!known.insert(file).second)
      throw ReadError(fmt::format("{}: two pieces have the same Source, {}", path, source));
    files.push_back(std::move(file));
  }
  return files;
}

TetMesh read_pvtu(const std::string& path) {
  std::vector<NamedPiece> pieces;
  for (const std::string& file : pieces_of_pvtu(path))
    for (VtkPiece& piece : read_vtu_pieces(file)) pieces.push_back({file, std::move(piece), {}});
  VtkPiece whole;
  join_points(pieces, whole);
  join_cells(pieces, whole);
  if (!pieces.empty()) whole.names = pieces.front().piece.names;  // each piece has all names
  TetMesh mesh;
  try {
    add_vtk_piece(whole, mesh);
  } catch (const VtkPieceError& error) {
    throw ReadError(fmt::format("{}: {}", path, error.message));
  }
  if (mesh.tets.empty()) throw ReadError(path + ": expected tetrahedra, found none");
  complete_vtk_mesh(path, mesh);
  return mesh;
}

}  // namespace collarmesh::io
