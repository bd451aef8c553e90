// Abaqus' and CalculiX's input format (.inp): nodes; tets as C3D4 or C3D10; prisms as C3D6 or C3D15; pyramids
// as C3D8 whose last four nodes are one (for second order see abaqus_pyramids.h); an element set for each
// region of the complex (VOLUME_1) and for each tag of regions (REGION_7); a surface for each tag of patches
// (PATCH_7: faces of the elements behind it); a node set for each tag of patches and curves (PATCH_7_NODES,
// CURVE_7_NODES). Conditions for periodic faces are in a second file beside the mesh. EALL contains all
// elements, NALL all nodes. In a mesh without tets, triangles are S3 or S6, or in the plane z = 0 CPS3, CPE6
// and so on, with an element set for each tag of patches (PATCH_7); curve edges without triangles are B31 or
// B32, one set for each tag of curves (CURVE_7). Numbers take 20 characters at most, as both programs
// require.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "collarmesh/error.h"
#include "io/abaqus_format.h"
#include "io/abaqus_interfaces.h"
#include "io/abaqus_periodic.h"
#include "io/abaqus_pyramids.h"
#include "io/cell_nodes.h"
#include "io/label_names.h"
#include "io/node_groups.h"
#include "io/number_text.h"
#include "io/sides_of_faces.h"
#include "io/tet_mesh_formats.h"
#include "io/write_each.h"

namespace collarmesh::io {

namespace {

constexpr std::size_t numbers_a_line = 16, number_width = 20;

/// Returns the shortest text that reads back as the same double, or, if that is too long, as many digits as
/// fit.
std::string fitted(double value) {
  std::string text = fmt::format("{}", value);
  for (int digits = 16; text.size() > number_width; --digits) text = fmt::format("{:.{}g}", value, digits);
  return text;
}

void write_numbers(FileWriter& out, const std::vector<Index>& numbers) {
  for (std::size_t i = 0; i < numbers.size(); ++i)
    out << numbers[i] << (i + 1 == numbers.size() || (i + 1) % numbers_a_line == 0 ? ",\n" : ", ");
}

/// Returns a name for the set of each tag. The names differ from each other and from those in `known`, to
/// which they are added.
NamesByTag set_names_of(const TetMesh& mesh, std::size_t dimension, const std::vector<Tag>& tags,
                        DistinctNames& known) {
  NamesByTag names;
  for (const auto& each : numbered_tags(tags))
    names[each.first] = known.add(capital_name(mesh, dimension, each.first));
  return names;
}

bool is_volume(std::string_view name) {
  Index region = 0;
  const std::string_view prefix = abaqus_volume_prefix;
  return name.starts_with(prefix) && parse(name.substr(prefix.size()), region);
}

/// Returns a name for each tag of regions. The names differ from each other and from those of our other
/// element sets.
NamesByTag names_of_regions(const TetMesh& mesh) {
  DistinctNames known(std::string::npos);
  known.add(capital_word(abaqus_everything));
  known.add(capital_word(abaqus_halves));
  const std::vector<Tag> tags = all_tags(mesh, 3);
  for (const auto& each : numbered_tags(tags))
    if (const std::string name = capital_name(mesh, 3, each.first); is_volume(name)) known.add(name);
  return set_names_of(mesh, 3, tags, known);
}

void write_node_sets(FileWriter& out, const Groups& groups, const NamesByTag& names) {
  for (const auto& [tag, nodes] : groups) {
    out << "*NSET, NSET=" << names.at(tag) << "_NODES\n";
    write_numbers(out, nodes);
  }
}

void write_nodes(FileWriter& out, const TetMesh& mesh, const std::vector<Point>& more) {
  out << "*NODE, NSET=NALL\n";
  const std::size_t points = mesh.points.size();
  write_each(out, points + more.size(), [&](TextBuffer& text, std::size_t i) {
    const Point& p = i < points ? mesh.points[i] : more[i - points];
    text << i + 1 << ", " << fitted(p.x) << ", " << fitted(p.y) << ", " << fitted(p.z) << '\n';
  });
}

const char* element_type_of(CellKind kind, int order) {
  if (kind == CellKind::tet) return order == 2 ? "C3D10" : "C3D4";
  if (kind == CellKind::prism) return order == 2 ? "C3D15" : "C3D6";
  return "C3D8";
}

/// Writes the cells of one kind in one region.
void write_elements_of(FileWriter& out, const TetMesh& mesh, const HalvedPyramids& halved, CellKind kind,
                       Index region, const std::vector<Index>& cells) {
  if (cells.empty()) return;
  const bool halves = kind == CellKind::pyramid && halved.any();
  out << "*ELEMENT, TYPE=" << element_type_of(halves ? CellKind::tet : kind, mesh.order())
      << ", ELSET=" << abaqus_volume_prefix << region << '\n';
  const std::size_t before = count_before(mesh, kind);
  const auto write = [](TextBuffer& text, std::size_t number, const auto& nodes) {
    text << number;
    for (const Index v : nodes) text << ", " << v + 1;
    text << '\n';
  };
  write_each(out, cells.size(), [&](TextBuffer& text, std::size_t i) {
    if (halves) {
      for (std::size_t k = 0; k < 2; ++k)
        write(text, before + 2 * std::size_t{cells[i]} + k + 1, halved.half(cells[i], k));
      return;
    }
    const CellNodes nodes = nodes_of(kind)(mesh, cells[i]);
    if (kind != CellKind::pyramid) {
      write(text, before + cells[i] + 1, nodes);
      return;
    }
    std::array<Index, abaqus_pyramid_order.size()> as_hexahedron{};
    for (std::size_t k = 0; k < as_hexahedron.size(); ++k) as_hexahedron[k] = nodes[abaqus_pyramid_order[k]];
    write(text, before + cells[i] + 1, as_hexahedron);
  });
}

/// Writes the set of the halves of pyramids, and the equations for the nodes in the middle of their bases.
void write_halves(FileWriter& out, const TetMesh& mesh, const HalvedPyramids& halved) {
  if (!halved.any()) return;
  out << "*ELSET, ELSET=" << capital_word(abaqus_halves) << '\n';
  std::vector<Index> numbers;
  for (std::size_t i = 0; i < 2 * mesh.layers.pyramids.size(); ++i)
    numbers.push_back(static_cast<Index>(count_before(mesh, CellKind::pyramid) + i + 1));
  write_numbers(out, numbers);
  halved.write_equations(out);
}

void write_elements(FileWriter& out, const TetMesh& mesh, const HalvedPyramids& halved) {
  std::map<Index, PerKind<std::vector<Index>>> volumes;
  for_each_kind(mesh, 3, [&](CellKind kind) {
    const std::vector<Index>& regions = features_of(mesh, kind);
    for (std::size_t i = 0; i < regions.size(); ++i)
      volumes[regions[i]][kind].push_back(static_cast<Index>(i));
  });
  std::map<Tag, std::vector<Index>> regions_of_tag;
  for (const auto& [region, tag] : tags_of_regions(mesh)) regions_of_tag[tag].push_back(region);
  for (const auto& [region, cells] : volumes)
    for (const CellKind kind : all_cell_kinds)
      write_elements_of(out, mesh, halved, kind, region, cells[kind]);
  out << "*ELSET, ELSET=EALL\n";
  for (const auto& volume : volumes) out << abaqus_volume_prefix << volume.first << ",\n";
  const NamesByTag names = names_of_regions(mesh);
  for (const auto& [tag, regions] : regions_of_tag) {
    out << "*ELSET, ELSET=" << names.at(tag) << '\n';
    for (const Index region : regions) out << abaqus_volume_prefix << region << ",\n";
  }
}

/// Writes the elements of a mesh without tets, in an element set for each tag. `nodes_of(i)` returns the
/// nodes of the i-th element in Abaqus' order.
template <class NodesOf>
void write_elements_by_tag(FileWriter& out, const std::vector<Tag>& tags, const std::string& type,
                           const NamesByTag& names, const NodesOf& nodes_of) {
  std::map<Tag, std::vector<Index>> members;
  for (std::size_t i = 0; i < tags.size(); ++i) members[tags[i]].push_back(static_cast<Index>(i));
  for (const auto& [tag, with_tag] : members) {
    const std::vector<Index>& elements = with_tag;  // a lambda cannot capture a structured binding
    out << "*ELEMENT, TYPE=" << type << ", ELSET=" << names.at(tag) << '\n';
    write_each(out, elements.size(), [&](TextBuffer& text, std::size_t i) {
      text << elements[i] + 1;
      for (const Index v : nodes_of(elements[i])) text << ", " << v + 1;
      text << '\n';
    });
  }
  out << "*ELSET, ELSET=EALL\n";
  for (const auto& each : members) out << names.at(each.first) << ",\n";
}

/// Rejects a mesh with points off the plane z = 0: solvers accept plane elements only there.
void require_plane(const std::string& path, const TetMesh& mesh) {
  constexpr double flat = 1e-9;
  Box box;
  for (const Point& p : mesh.points) box.add(p);
  for (const Point& p : mesh.points)
    if (std::fabs(p.z) > flat * box.diagonal())
      throw WriteError(fmt::format(
          "{}: plane-stress and plane-strain elements must lie in the plane z = 0, but there is a node at "
          "({:.6g}, {:.6g}, {:.6g}); move or turn the domain into this plane, or leave out "
          "--triangle-elements",
          path, p.x, p.y, p.z));
}

/// Returns the nodes of a triangle in the plane z = 0, counterclockwise as seen from above.
CellNodes nodes_of_plane_face(const TetMesh& mesh, std::size_t face) {
  constexpr std::array<std::uint8_t, 3> turned{0, 2, 1};
  constexpr std::array<std::uint8_t, 6> turned_curved{0, 2, 1, 5, 4, 3};
  const CellNodes nodes = nodes_of_face(mesh, face);
  const auto& [a, b, c] = mesh.faces[face];
  if (cross(mesh.points[b] - mesh.points[a], mesh.points[c] - mesh.points[a]).z > 0) return nodes;
  return nodes.size() == turned.size() ? nodes.in_order(turned) : nodes.in_order(turned_curved);
}

/// Writes triangles as shell elements or plane elements.
void write_triangles(FileWriter& out, const TetMesh& mesh, const NamesByTag& names) {
  const std::size_t nodes = mesh.order() == 2 ? 6 : 3;
  if (mesh.triangle_elements == TriangleElements::shell) {
    write_elements_by_tag(out, mesh.face_tag, fmt::format("S{}", nodes), names,
                          [&](Index face) { return nodes_of_face(mesh, face); });
    return;
  }
  const char* const kind = mesh.triangle_elements == TriangleElements::plane_stress ? "CPS" : "CPE";
  write_elements_by_tag(out, mesh.face_tag, fmt::format("{}{}", kind, nodes), names,
                        [&](Index face) { return nodes_of_plane_face(mesh, face); });
}

/// Writes edges as beams; in the file the mid-edge node is the second of three.
void write_beams(FileWriter& out, const TetMesh& mesh, const NamesByTag& names) {
  constexpr std::array<std::uint8_t, 3> order{0, 2, 1};
  write_elements_by_tag(out, mesh.edge_tag, mesh.order() == 2 ? "B32" : "B31", names,
                        [&](Index edge) { return nodes_of_edge(mesh, edge).in_order(order); });
}

/// Writes for each face the element behind it, and that element's side.
void write_surfaces(FileWriter& out, const TetMesh& mesh, const HalvedPyramids& halved,
                    const NamesByTag& names) {
  for (const auto& [tag, members] : sides_by_tag(mesh)) {
    out << "*SURFACE, NAME=" << names.at(tag) << ", TYPE=ELEMENT\n";
    for (const auto& [kind, cell, side] : members) {
      const std::size_t before = count_before(mesh, kind);
      if (kind == CellKind::pyramid && halved.any())
        for (const auto& [half, number] : halved.sides(cell, side))
          out << before + 2 * std::size_t{cell} + half + 1 << ", S" << number << '\n';
      else
        out << before + cell + 1 << ", S" << abaqus_faces(kind)[side] << '\n';
    }
  }
}

}  // namespace

void write_abaqus(const std::string& path, const TetMesh& mesh) { write_abaqus(path, mesh, {}); }

void write_abaqus(const std::string& path, const TetMesh& mesh, const Interfaces& interfaces) {
  const bool without_tets = mesh.is_surface() || mesh.is_curves();
  if (mesh.is_surface() && mesh.triangle_elements != TriangleElements::shell) require_plane(path, mesh);
  FileWriter out(path);
  out << "*HEADING\nWritten by collarmesh.\n";
  const HalvedPyramids halved(mesh);
  write_nodes(out, mesh, halved.nodes());
  DistinctNames known(std::string::npos);
  if (without_tets)
    known.add(capital_word(abaqus_everything));
  else
    write_elements(out, mesh, halved);
  const NamesByTag patches = set_names_of(mesh, 2, all_tags(mesh, 2), known),
                   curves = set_names_of(mesh, 1, mesh.edge_tag, known);
  if (mesh.is_curves())
    write_beams(out, mesh, curves);
  else if (mesh.is_surface())
    write_triangles(out, mesh, patches);
  else
    write_surfaces(out, mesh, halved, patches);
  write_node_sets(out, nodes_by_tag(mesh, 2), patches);
  write_node_sets(out, nodes_by_tag(mesh, 1), curves);
  write_halves(out, mesh, halved);
  write_abaqus_interfaces(out, mesh, interfaces, patches);
  out.commit();
  if (!mesh.periodic.empty()) write_abaqus_periodic(abaqus_periodic_path(path), mesh);
}

}  // namespace collarmesh::io
