// OpenFOAM's polyMesh: the file `boundary` and beside it `points`, `faces`, `owner`, `neighbour`, `cellZones`
// and `faceZones` (OpenFOAM User Guide, "Mesh description"). Each tag of faces on the boundary is a patch.
// Its type is wall or symmetry if its name begins with that word. Each tag of regions is a zone of cells, and
// each tag of faces inside is a zone of faces.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "collarmesh/error.h"
#include "common/face_finder.h"
#include "io/cell_nodes.h"
#include "io/label_names.h"
#include "io/node_groups.h"
#include "io/tet_mesh_formats.h"
#include "io/write_each.h"

namespace collarmesh::io {

namespace {

/// Corners of a triangle or quadrangle, the smallest first; a triangle's fourth one is `none`.
using Corners = std::array<Index, 4>;

std::size_t count_corners(const Corners& corners) { return corners[3] == none ? 3 : 4; }

/// A side of a cell, which is its owner; the corners are counterclockwise as seen from outside the owner. The
/// neighbour is the cell on the other side, or none.
struct Side {
  Corners corners;
  Index owner = none, neighbour = none;
  Index face = none;  ///< index among the mesh's triangles or quadrangles; none: it is not among them

  bool is_triangle() const { return corners[3] == none; }
  std::array<Index, 3> triangle() const { return {corners[0], corners[1], corners[2]}; }
  CellKind kind() const { return is_triangle() ? CellKind::triangle : CellKind::quadrangle; }
};

/// Returns the tag of a side that is a face of the mesh.
Tag tag_of(const TetMesh& mesh, const Side& side) { return tags_of(mesh, side.kind())[side.face]; }

/// The sides inside the mesh, sorted by owner and neighbour, and those on its boundary, sorted by tag.
struct Sides {
  std::vector<Side> inside, outside;

  explicit Sides(const TetMesh& mesh) {
    collect(mesh);
    FaceFinder triangles(mesh.faces);
    PolygonFinder<4> quadrangles(mesh.layers.quads);
    for (auto* sides : {&inside, &outside})
      for (Side& side : *sides)
        side.face = side.is_triangle() ? triangles.find(side.triangle()) : quadrangles.find(side.corners);
    std::sort(inside.begin(), inside.end(), [](const Side& a, const Side& b) {
      return std::pair(a.owner, a.neighbour) < std::pair(b.owner, b.neighbour);
    });
    const auto tag = [&](const Side& side) { return side.face == none ? Tag{0} : tag_of(mesh, side); };
    std::stable_sort(outside.begin(), outside.end(),
                     [&](const Side& a, const Side& b) { return tag(a) < tag(b); });
  }

 private:
  void collect(const TetMesh& mesh) {
    std::vector<Side> all;
    all.reserve(4 * mesh.tets.size() + 5 * (mesh.layers.prisms.size() + mesh.layers.pyramids.size()));
    for_each_kind(mesh, 3, [&](CellKind kind) {
      const std::size_t before = count_before(mesh, kind);
      for (std::size_t i = 0; i < count_of(mesh, kind); ++i) {
        const CellNodes nodes = nodes_of(kind)(mesh, i);
        for (const auto& [count, places] : shape_of(kind).sides) {
          Corners corners{none, none, none, none};
          for (std::size_t k = 0; k < count; ++k) corners[k] = nodes[places[k]];
          const auto end = corners.begin() + static_cast<std::ptrdiff_t>(count);
          std::rotate(corners.begin(), std::min_element(corners.begin(), end), end);
          all.push_back({corners, static_cast<Index>(before + i)});
        }
      }
    });
    pair_up(all);
  }

  /// Joins the two sides of each inner face: the cell with the smaller number becomes the owner.
  void pair_up(std::vector<Side>& all) {
    const auto key = [](const Side& side) {
      const auto& [a, b, c, d] = side.corners;  // a is the smallest, d often none
      Corners sorted{a, std::min(b, c), std::max(b, c), d};
      if (d != none) std::sort(sorted.begin() + 1, sorted.end());
      return sorted;
    };
    std::sort(all.begin(), all.end(), [&](const Side& a, const Side& b) {
      if (a.corners[0] != b.corners[0]) return a.corners[0] < b.corners[0];
      const Corners first = key(a), second = key(b);
      return first != second ? first < second : a.owner < b.owner;
    });
    for (std::size_t i = 0; i < all.size(); ++i) {
      Side side = all[i];
      if (i + 1 < all.size() && key(all[i]) == key(all[i + 1])) side.neighbour = all[++i].owner;
      (side.neighbour == none ? outside : inside).push_back(side);
    }
  }
};

std::string header(std::string_view kind, std::string_view object, std::string_view note = {}) {
  std::string text =
      fmt::format("FoamFile\n{{\n    version     2.0;\n    format      ascii;\n    class       {};\n", kind);
  if (!note.empty()) text += fmt::format("    note        \"{}\";\n", note);
  return text + fmt::format("    location    \"constant/polyMesh\";\n    object      {};\n}}\n\n", object);
}

/// A writer of one file of the folder.
class List {
 public:
  List(const std::filesystem::path& folder, const char* name, std::string_view kind,
       std::string_view note = {})
      : out_((folder / name).string()) {
    out_ << header(kind, name, note);
  }
  template <class Write>
  void write(std::size_t count, const Write& write) {
    out_ << count << "\n(\n";
    write_each(out_, count, write);
    out_ << ")\n";
  }
  FileWriter& out() { return out_; }
  void commit() { out_.commit(); }

 private:
  FileWriter out_;
};

const char* type_of(const std::string& name) {
  const std::string lower = lower_case(name);
  if (lower.starts_with("wall")) return "wall";
  return lower.starts_with("symmetry") ? "symmetry" : "patch";
}

void write_boundary(FileWriter& out, const TetMesh& mesh, const Sides& sides) {
  struct Patch {
    std::size_t first = 0, count = 0;
  };
  std::map<std::string, Patch> patches;
  std::vector<std::string> order;
  for (std::size_t i = 0; i < sides.outside.size(); ++i) {
    const Index face = sides.outside[i].face;
    const std::string name = face == none ? "untagged" : word_name(mesh, 2, tag_of(mesh, sides.outside[i]));
    const auto [patch, added] = patches.try_emplace(name, Patch{sides.inside.size() + i, 0});
    if (added) order.push_back(name);
    ++patch->second.count;
  }
  out << order.size() << "\n(\n";
  for (const std::string& name : order)
    out << fmt::format(
        "    {}\n    {{\n        type            {};\n        nFaces          {};\n        startFace       "
        "{};\n    }}\n",
        name, type_of(name), patches[name].count, patches[name].first);
  out << ")\n";
}

void write_labels(FileWriter& out, const char* what, const std::vector<Index>& labels) {
  out << fmt::format("        {}      List<label>\n{}\n(\n", what, labels.size());
  for (const Index label : labels) out << label << '\n';
  out << ")\n;\n";
}

void write_cell_zones(FileWriter& out, const TetMesh& mesh) {
  const Groups zones = volumes_by_tag(mesh, 0);
  out << zones.size() << "\n(\n";
  for (const auto& [tag, cells] : zones) {
    out << word_name(mesh, 3, tag) << "\n{\n        type            cellZone;\n";
    write_labels(out, "cellLabels", cells);
    out << "}\n";
  }
  out << ")\n";
}

bool is_flipped(const TetMesh& mesh, const Side& side) {
  return side.is_triangle() ? !FaceFinder::alike(mesh.faces[side.face], side.triangle())
                            : !PolygonFinder<4>::alike(mesh.layers.quads[side.face], side.corners);
}

/// Writes zones of faces. A face is flipped if its normal in `mesh` points into the owner.
void write_face_zones(FileWriter& out, const TetMesh& mesh, const Sides& sides) {
  Groups zones;
  for (std::size_t i = 0; i < sides.inside.size(); ++i)
    if (sides.inside[i].face != none) zones[tag_of(mesh, sides.inside[i])].push_back(static_cast<Index>(i));
  out << zones.size() << "\n(\n";
  for (const auto& [tag, faces] : zones) {
    out << word_name(mesh, 2, tag) << "\n{\n        type            faceZone;\n";
    write_labels(out, "faceLabels", faces);
    out << fmt::format("        flipMap         List<bool>\n{}\n(\n", faces.size());
    for (const Index i : faces) out << (is_flipped(mesh, sides.inside[i]) ? "1\n" : "0\n");
    out << ")\n;\n}\n";
  }
  out << ")\n";
}

}  // namespace

void write_openfoam(const std::string& path, const TetMesh& mesh) {
  const std::filesystem::path boundary_path(path), folder = boundary_path.parent_path();
  if (boundary_path.filename() != "boundary")
    throw WriteError(
        path + ": a polyMesh is named by its file boundary; give a path such as constant/polyMesh/boundary");
  if (mesh.order() == 2)
    throw WriteError(path + ": a polyMesh has no elements of second order; write those of first order");
  const Sides sides(mesh);
  const std::size_t inside = sides.inside.size(), all = inside + sides.outside.size();
  const auto side = [&](std::size_t i) -> const Side& {
    return i < inside ? sides.inside[i] : sides.outside[i - inside];
  };
  const std::string note = fmt::format("nPoints:{} nCells:{} nFaces:{} nInternalFaces:{}", mesh.points.size(),
                                       count_of_dimension(mesh, 3), all, inside);
  List points(folder, "points", "vectorField"), faces(folder, "faces", "faceList"),
      owner(folder, "owner", "labelList", note), neighbour(folder, "neighbour", "labelList", note),
      cell_zones(folder, "cellZones", "regIOobject"), face_zones(folder, "faceZones", "regIOobject"),
      boundary(folder, "boundary", "polyBoundaryMesh");
  points.write(mesh.points.size(),
               [&](TextBuffer& text, std::size_t i) { text << '(' << mesh.points[i] << ")\n"; });
  faces.write(all, [&](TextBuffer& text, std::size_t i) {
    const Corners& corners = side(i).corners;
    const std::size_t count = count_corners(corners);
    text << count;
    for (std::size_t k = 0; k < count; ++k) text << (k == 0 ? '(' : ' ') << corners[k];
    text << ")\n";
  });
  owner.write(all, [&](TextBuffer& text, std::size_t i) { text << side(i).owner << '\n'; });
  neighbour.write(inside, [&](TextBuffer& text, std::size_t i) { text << side(i).neighbour << '\n'; });
  write_cell_zones(cell_zones.out(), mesh);
  write_face_zones(face_zones.out(), mesh, sides);
  write_boundary(boundary.out(), mesh, sides);
  for (List* list : {&points, &faces, &owner, &neighbour, &cell_zones, &face_zones, &boundary})
    list->commit();
}

}  // namespace collarmesh::io
