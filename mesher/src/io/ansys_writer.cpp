// Ansys' archive format (.cdb; Mechanical APDL, "Guide to Interfacing with ANSYS", NBLOCK, EBLOCK and
// CMBLOCK): nodes, SOLID285 or SOLID187 with the region as material, a component of elements for each tag of
// regions and of nodes for each tag of patches and curves.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "io/cell_nodes.h"
#include "io/label_names.h"
#include "io/node_groups.h"
#include "io/tet_mesh_formats.h"
#include "io/write_each.h"

namespace collarmesh::io {

namespace {

constexpr std::size_t nodes_on_line = 8, numbers_on_line = 8;
constexpr std::size_t longest_name = 32;

/// Formats as 6e21.13e3: the exponent has three digits.
std::string real(double value) {
  std::string text = fmt::format("{:.13E}", value);
  const std::size_t sign = text.find('E') + 1;
  text.insert(sign + 1, 3 - (text.size() - sign - 1), '0');
  return fmt::format("{:>21}", text);
}

void write_nodes(FileWriter& out, const TetMesh& mesh) {
  out << fmt::format("NBLOCK,6,SOLID,{0:10},{0:10}\n(3i9,6e21.13e3)\n", mesh.points.size());
  write_each(out, mesh.points.size(), [&](TextBuffer& text, std::size_t i) {
    const Point& p = mesh.points[i];
    text << std::string_view(
        fmt::format("{:9}{:9}{:9}{}{}{}\n", i + 1, 0, 0, real(p.x), real(p.y), real(p.z)));
  });
  out << "N,R5.3,LOC,       -1,\n";
}

/// Writes elements: material, type, further fields that are 1 or 0, the number of nodes, 0, the number of the
/// element, the nodes.
void write_elements(FileWriter& out, const TetMesh& mesh) {
  out << fmt::format("EBLOCK,19,SOLID,{0:10},{0:10}\n(19i9)\n", mesh.tets.size());
  write_each(out, mesh.tets.size(), [&](TextBuffer& text, std::size_t i) {
    const CellNodes nodes = nodes_of_tet(mesh, i);
    std::string line = fmt::format("{:9}{:9}{:9}{:9}{:9}{:9}{:9}{:9}{:9}{:9}{:9}", mesh.tet_region[i], 1, 1,
                                   1, 0, 0, 0, 0, nodes.size(), 0, i + 1);
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      if (k == nodes_on_line) line += '\n';
      line += fmt::format("{:9}", nodes[k] + 1);
    }
    text << std::string_view(line) << '\n';
  });
  out << "       -1\n";
}

/// Returns a name that no component has yet, without hyphens.
std::string new_name(const TetMesh& mesh, std::size_t dimension, Tag tag, DistinctNames& known) {
  std::string name = capital_name(mesh, dimension, tag);
  std::replace(name.begin(), name.end(), '-', '_');
  return known.add(name);
}

void write_components(FileWriter& out, const TetMesh& mesh, std::size_t dimension, const Groups& groups,
                      DistinctNames& known) {
  for (const auto& [tag, members] : groups) {
    out << fmt::format("CMBLOCK,{},{},{:8}\n(8i10)\n", new_name(mesh, dimension, tag, known),
                       dimension == 3 ? "ELEM" : "NODE", members.size());
    for (std::size_t i = 0; i < members.size(); ++i)
      out << fmt::format("{:10}{}", members[i],
                         i + 1 == members.size() || (i + 1) % numbers_on_line == 0 ? "\n" : "");
  }
}

}  // namespace

void write_ansys(const std::string& path, const TetMesh& mesh) {
  FileWriter out(path);
  out << "/COM,Written by collarmesh.\n/PREP7\nET,1," << (mesh.order() == 2 ? 187 : 285) << '\n';
  write_nodes(out, mesh);
  write_elements(out, mesh);
  DistinctNames known(longest_name);
  Groups regions;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    regions[mesh.tet_tag[t]].push_back(static_cast<Index>(t + 1));
  write_components(out, mesh, 3, regions, known);
  write_components(out, mesh, 2, nodes_by_tag(mesh, nodes_of_face, mesh.face_tag), known);
  write_components(out, mesh, 1, nodes_by_tag(mesh, nodes_of_edge, mesh.edge_tag), known);
  out << "FINISH\n";
  out.commit();
}

}  // namespace collarmesh::io
