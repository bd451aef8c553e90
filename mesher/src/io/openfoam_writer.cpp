// OpenFOAM's polyMesh: the file `boundary` and beside it `points`, `faces`, `owner`, `neighbour`, `cellZones`
// and `faceZones` (OpenFOAM User Guide, "Mesh description"). Each tag of faces on the boundary is a patch, of
// type wall if its name begins with wall, and symmetry likewise. Each tag of regions is a zone of cells, and
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
#include "io/face_finder.h"
#include "io/label_names.h"
#include "io/node_groups.h"
#include "io/tet_mesh_formats.h"
#include "io/write_each.h"

namespace collarmesh::io {

namespace {

using Triangle = std::array<Index, 3>;

/// A side of a tet, with its corners as seen from outside, and the tet in front of it, or none.
struct Side {
  Triangle corners;
  Index owner = none, neighbour = none;
  Index face = none;  ///< index among the faces of the mesh
};

/// Rotates a triangle so that its smallest corner comes first; its orientation stays.
Triangle turned(Triangle t) {
  std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  return t;
}

/// Inner sides by owner and neighbour, then sides on the boundary by tag.
struct Sides {
  std::vector<Side> inside, outside;

  explicit Sides(const TetMesh& mesh) {
    collect(mesh);
    FaceFinder finder(mesh.faces);
    for (auto* sides : {&inside, &outside})
      for (Side& side : *sides) side.face = finder.find(side.corners);
    std::sort(inside.begin(), inside.end(), [](const Side& a, const Side& b) {
      return std::pair(a.owner, a.neighbour) < std::pair(b.owner, b.neighbour);
    });
    const auto tag = [&](const Side& side) { return side.face == none ? Tag{0} : mesh.face_tag[side.face]; };
    std::stable_sort(outside.begin(), outside.end(),
                     [&](const Side& a, const Side& b) { return tag(a) < tag(b); });
  }

 private:
  void collect(const TetMesh& mesh) {
    std::vector<Side> all;
    all.reserve(4 * mesh.tets.size());
    constexpr std::array<std::array<std::size_t, 3>, 4> outward{{{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};
    for (std::size_t t = 0; t < mesh.tets.size(); ++t)
      for (const auto& [i, j, k] : outward)
        all.push_back({turned({mesh.tets[t][i], mesh.tets[t][j], mesh.tets[t][k]}), static_cast<Index>(t)});
    // The two sides of a face come one after the other, the owner's first.
    const auto key = [](const Side& side) {
      const auto& [a, b, c] = side.corners;
      return std::array{a, std::min(b, c), std::max(b, c), side.owner};
    };
    std::sort(all.begin(), all.end(), [&](const Side& a, const Side& b) { return key(a) < key(b); });
    const auto alike = [&](std::size_t i) {
      if (i + 1 == all.size()) return false;
      const auto a = key(all[i]), b = key(all[i + 1]);
      return std::equal(a.begin(), a.begin() + 3, b.begin());
    };
    for (std::size_t i = 0; i < all.size(); ++i) {
      Side side = all[i];
      if (alike(i)) side.neighbour = all[++i].owner;
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

/// Writes a file of the folder.
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
    const std::string name = face == none ? "untagged" : word_name(mesh, 2, mesh.face_tag[face]);
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
  Groups zones;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) zones[mesh.tet_tag[t]].push_back(static_cast<Index>(t));
  out << zones.size() << "\n(\n";
  for (const auto& [tag, cells] : zones) {
    out << word_name(mesh, 3, tag) << "\n{\n        type            cellZone;\n";
    write_labels(out, "cellLabels", cells);
    out << "}\n";
  }
  out << ")\n";
}

/// Writes zones of faces. A face is flipped if its zone's normal points to the owner.
void write_face_zones(FileWriter& out, const TetMesh& mesh, const Sides& sides) {
  Groups zones;
  for (std::size_t i = 0; i < sides.inside.size(); ++i)
    if (sides.inside[i].face != none)
      zones[mesh.face_tag[sides.inside[i].face]].push_back(static_cast<Index>(i));
  out << zones.size() << "\n(\n";
  for (const auto& [tag, faces] : zones) {
    out << word_name(mesh, 2, tag) << "\n{\n        type            faceZone;\n";
    write_labels(out, "faceLabels", faces);
    out << fmt::format("        flipMap         List<bool>\n{}\n(\n", faces.size());
    for (const Index i : faces)
      out << (FaceFinder::alike(mesh.faces[sides.inside[i].face], sides.inside[i].corners) ? "0\n" : "1\n");
    out << ")\n;\n}\n";
  }
  out << ")\n";
}

}  // namespace

void write_openfoam(const std::string& path, const TetMesh& mesh) {
  const std::filesystem::path boundary_path(path), folder = boundary_path.parent_path();
  if (boundary_path.filename() != "boundary")
    throw WriteError(path + ": a polyMesh is written as its file boundary; name constant/polyMesh/boundary");
  if (mesh.order() == 2)
    throw WriteError(path + ": a polyMesh has no elements of second order; write those of first order");
  const Sides sides(mesh);
  const std::size_t inside = sides.inside.size(), all = inside + sides.outside.size();
  const auto side = [&](std::size_t i) -> const Side& {
    return i < inside ? sides.inside[i] : sides.outside[i - inside];
  };
  const std::string note = fmt::format("nPoints:{} nCells:{} nFaces:{} nInternalFaces:{}", mesh.points.size(),
                                       mesh.tets.size(), all, inside);
  List points(folder, "points", "vectorField"), faces(folder, "faces", "faceList"),
      owner(folder, "owner", "labelList", note), neighbour(folder, "neighbour", "labelList", note),
      cell_zones(folder, "cellZones", "regIOobject"), face_zones(folder, "faceZones", "regIOobject"),
      boundary(folder, "boundary", "polyBoundaryMesh");
  points.write(mesh.points.size(), [&](TextBuffer& text, std::size_t i) {
    const Point& p = mesh.points[i];
    text << '(' << p.x << ' ' << p.y << ' ' << p.z << ")\n";
  });
  faces.write(all, [&](TextBuffer& text, std::size_t i) {
    const auto& [a, b, c] = side(i).corners;
    text << "3(" << a << ' ' << b << ' ' << c << ")\n";
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
