// Ansys' archive format (.cdb; Mechanical APDL, "Guide to Interfacing with ANSYS", NBLOCK, EBLOCK and
// CMBLOCK): nodes; tets as SOLID285 or SOLID187, prisms and pyramids as SOLID185 or SOLID186, with the region
// as material; a component of elements for each tag of regions; a component of nodes for each tag of patches
// and curves.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
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
constexpr std::size_t longest_component = 32;

/// Formats a number as one field of Fortran's format 6e21.13e3: the exponent has three digits.
std::string real_field(double value) {
  std::string text = fmt::format("{:.13E}", value);
  const std::size_t sign = text.find('E') + 1;
  text.insert(sign + 1, 3 - (text.size() - sign - 1), '0');
  return fmt::format("{:>21}", text);
}

void write_nblock(FileWriter& out, const TetMesh& mesh) {
  out << fmt::format("NBLOCK,6,SOLID,{0:10},{0:10}\n(3i9,6e21.13e3)\n", mesh.points.size());
  write_each(out, mesh.points.size(), [&](TextBuffer& text, std::size_t i) {
    const Point& p = mesh.points[i];
    text << std::string_view(
        fmt::format("{:9}{:9}{:9}{}{}{}\n", i + 1, 0, 0, real_field(p.x), real_field(p.y), real_field(p.z)));
  });
  out << "N,R5.3,LOC,       -1,\n";
}

/// Ansys' type of elements for a kind of cells. Prisms and pyramids are hexahedra with coinciding nodes.
struct AnsysType {
  CellKind kind;
  int number;                           ///< number of the type, as ET sets it
  std::array<std::size_t, 2> nodes;     ///< number of nodes, by order
  std::array<std::uint8_t, 20> places;  ///< our node at each place
};
constexpr std::array<AnsysType, 3> ansys_types{
    {{CellKind::tet, 1, {4, 10}, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9}},
     {CellKind::prism, 2, {8, 20}, {0, 1, 2, 2, 3, 4, 5, 5, 6, 7, 2, 8, 9, 10, 5, 11, 12, 13, 14, 14}},
     {CellKind::pyramid, 2, {8, 20}, {0, 1, 2, 3, 4, 4, 4, 4, 5, 6, 7, 8, 4, 4, 4, 4, 9, 10, 11, 12}}}};

/// Writes elements: material, type, further fields that are 1 or 0, the number of nodes, 0, the number of the
/// element, the nodes.
void write_elements(FileWriter& out, const TetMesh& mesh) {
  out << fmt::format("EBLOCK,19,SOLID,{0:10},{0:10}\n(19i9)\n", count_of_dimension(mesh, 3));
  for (const AnsysType& type : ansys_types) {
    const std::span order(type.places.data(), type.nodes[mesh.order() == 2 ? 1 : 0]);
    const std::size_t before = count_before(mesh, type.kind);
    write_each(out, count_of(mesh, type.kind), [&](TextBuffer& text, std::size_t i) {
      const CellNodes nodes = nodes_of(type.kind)(mesh, i);
      std::string line =
          fmt::format("{:9}{:9}{:9}{:9}{:9}{:9}{:9}{:9}{:9}{:9}{:9}", features_of(mesh, type.kind)[i],
                      type.number, 1, 1, 0, 0, 0, 0, order.size(), 0, before + i + 1);
      for (std::size_t k = 0; k < order.size(); ++k) {
        if (k == nodes_on_line) line += '\n';
        line += fmt::format("{:9}", nodes[order[k]] + 1);
      }
      text << std::string_view(line) << '\n';
    });
  }
  out << "       -1\n";
}

/// Returns a name without hyphens that no component has yet, and adds it to `known`.
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
  if (!mesh.layers.prisms.empty() || !mesh.layers.pyramids.empty())
    out << "ET,2," << (mesh.order() == 2 ? 186 : 185) << '\n';
  write_nblock(out, mesh);
  write_elements(out, mesh);
  DistinctNames known(longest_component);
  write_components(out, mesh, 3, volumes_by_tag(mesh, 1), known);
  write_components(out, mesh, 2, nodes_by_tag(mesh, 2), known);
  write_components(out, mesh, 1, nodes_by_tag(mesh, 1), known);
  out << "FINISH\n";
  out.commit();
}

}  // namespace collarmesh::io
