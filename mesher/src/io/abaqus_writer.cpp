// Abaqus' and CalculiX' input format (.inp): nodes, C3D4 or C3D10, an element set for each region of the
// complex (VOLUME_1) and for each of their tags (REGION_7), a surface for each tag of patches (PATCH_7:
// faces of the tets behind it), a node set for each tag of patches and curves (PATCH_7_NODES,
// CURVE_7_NODES). Conditions for periodic faces are a file of their own beside it. EALL and NALL are
// everything. Triangles alone are S3 or S6, an element set for each tag of patches (PATCH_7). Numbers take 20
// characters at most, as both programs ask.
#include <fmt/format.h>

#include <array>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "io/abaqus_format.h"
#include "io/abaqus_interfaces.h"
#include "io/abaqus_periodic.h"
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

/// The shortest text that reads back as the same double, or the most digits that fit.
std::string fitted(double value) {
  std::string text = fmt::format("{}", value);
  for (int digits = 16; text.size() > number_width; --digits) text = fmt::format("{:.{}g}", value, digits);
  return text;
}

void write_numbers(FileWriter& out, const std::vector<Index>& numbers) {
  for (std::size_t i = 0; i < numbers.size(); ++i)
    out << numbers[i] << (i + 1 == numbers.size() || (i + 1) % numbers_a_line == 0 ? ",\n" : ", ");
}

using Names = std::map<Tag, std::string>;

/// Names of sets, all different from each other and from those that are known.
Names names_of(const TetMesh& mesh, std::size_t dimension, const std::vector<Tag>& tags,
               DistinctNames& known) {
  Names names;
  for (const auto& each : numbered_tags(tags))
    names[each.first] = known.add(capital_name(mesh, dimension, each.first));
  return names;
}

bool is_volume(std::string_view name) {
  Index region = 0;
  const std::string_view prefix = abaqus_volume_prefix;
  return name.starts_with(prefix) && parse(name.substr(prefix.size()), region);
}

/// As above, and different from those of our own sets of elements.
Names names_of_regions(const TetMesh& mesh) {
  DistinctNames known(std::string::npos);
  known.add(capital_word(abaqus_everything));
  for (const auto& each : numbered_tags(mesh.tet_tag))
    if (const std::string name = capital_name(mesh, 3, each.first); is_volume(name)) known.add(name);
  return names_of(mesh, 3, mesh.tet_tag, known);
}

void write_node_sets(FileWriter& out, const Groups& groups, const Names& names) {
  for (const auto& [tag, nodes] : groups) {
    out << "*NSET, NSET=" << names.at(tag) << "_NODES\n";
    write_numbers(out, nodes);
  }
}

void write_nodes(FileWriter& out, const TetMesh& mesh) {
  out << "*NODE, NSET=NALL\n";
  write_each(out, mesh.points.size(), [&](TextBuffer& text, std::size_t i) {
    const Point& p = mesh.points[i];
    text << i + 1 << ", " << fitted(p.x) << ", " << fitted(p.y) << ", " << fitted(p.z) << '\n';
  });
}

void write_elements(FileWriter& out, const TetMesh& mesh) {
  std::map<Index, std::vector<Index>> volumes;
  std::map<Tag, std::vector<Index>> regions_of_tag;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    volumes[mesh.tet_region[t]].push_back(static_cast<Index>(t));
  for (const auto& [region, tets_of_region] : volumes) {
    const std::vector<Index>& tets = tets_of_region;  // compilers differ in capturing the other name
    regions_of_tag[mesh.tet_tag[tets.front()]].push_back(region);
    out << "*ELEMENT, TYPE=" << (mesh.order() == 2 ? "C3D10" : "C3D4") << ", ELSET=" << abaqus_volume_prefix
        << region << '\n';
    write_each(out, tets.size(), [&](TextBuffer& text, std::size_t i) {
      text << tets[i] + 1;
      for (const Index v : nodes_of_tet(mesh, tets[i])) text << ", " << v + 1;
      text << '\n';
    });
  }
  out << "*ELSET, ELSET=EALL\n";
  for (const auto& volume : volumes) out << abaqus_volume_prefix << volume.first << ",\n";
  const Names names = names_of_regions(mesh);
  for (const auto& [tag, regions] : regions_of_tag) {
    out << "*ELSET, ELSET=" << names.at(tag) << '\n';
    for (const Index region : regions) out << abaqus_volume_prefix << region << ",\n";
  }
}

/// Triangles as elements of shells.
void write_shell_elements(FileWriter& out, const TetMesh& mesh, const Names& names) {
  std::map<Tag, std::vector<Index>> faces_of_tag;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f)
    faces_of_tag[mesh.face_tag[f]].push_back(static_cast<Index>(f));
  for (const auto& [tag, faces_with_tag] : faces_of_tag) {
    const std::vector<Index>& faces = faces_with_tag;  // as above
    out << "*ELEMENT, TYPE=" << (mesh.order() == 2 ? "S6" : "S3") << ", ELSET=" << names.at(tag) << '\n';
    write_each(out, faces.size(), [&](TextBuffer& text, std::size_t i) {
      text << faces[i] + 1;
      for (const Index v : nodes_of_face(mesh, faces[i])) text << ", " << v + 1;
      text << '\n';
    });
  }
  out << "*ELSET, ELSET=EALL\n";
  for (const auto& each : faces_of_tag) out << names.at(each.first) << ",\n";
}

/// The element and its side that lie behind each face.
void write_surfaces(FileWriter& out, const TetMesh& mesh, const Names& names) {
  std::map<Tag, std::vector<SideOfTet>> surfaces;
  const std::vector<SideOfTet> sides = sides_of_faces(mesh);
  for (std::size_t f = 0; f < mesh.faces.size(); ++f)
    if (sides[f].tet != none) surfaces[mesh.face_tag[f]].push_back(sides[f]);
  for (const auto& [tag, members] : surfaces) {
    out << "*SURFACE, NAME=" << names.at(tag) << ", TYPE=ELEMENT\n";
    for (const SideOfTet& side : members)
      out << side.tet + 1 << ", S" << abaqus_face_opposite[side.opposite] << '\n';
  }
}

}  // namespace

void write_abaqus(const std::string& path, const TetMesh& mesh) { write_abaqus(path, mesh, {}); }

void write_abaqus(const std::string& path, const TetMesh& mesh, const Interfaces& interfaces) {
  FileWriter out(path);
  out << "*HEADING\nWritten by collarmesh.\n";
  write_nodes(out, mesh);
  DistinctNames known(std::string::npos);
  if (mesh.is_surface())
    known.add(capital_word(abaqus_everything));
  else
    write_elements(out, mesh);
  const Names patches = names_of(mesh, 2, mesh.face_tag, known),
              curves = names_of(mesh, 1, mesh.edge_tag, known);
  if (mesh.is_surface())
    write_shell_elements(out, mesh, patches);
  else
    write_surfaces(out, mesh, patches);
  write_node_sets(out, nodes_by_tag(mesh, nodes_of_face, mesh.face_tag), patches);
  write_node_sets(out, nodes_by_tag(mesh, nodes_of_edge, mesh.edge_tag), curves);
  write_abaqus_interfaces(out, mesh, interfaces, patches);
  out.commit();
  if (!mesh.periodic.empty()) write_abaqus_periodic(abaqus_periodic_path(path), mesh);
}

}  // namespace collarmesh::io
