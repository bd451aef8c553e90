// Nastran's bulk data (.bdf; MSC Nastran Quick Reference Guide): nodes in large fields, CTETRA of 4 or 10
// nodes, CTRIA3 or CTRIA6 of the faces. Each region and then each tag of faces has a property number;
// comments give its name, as HyperMesh does. The user adds properties and materials, and deletes faces that
// need none.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string>

#include "io/cell_nodes.h"
#include "io/label_names.h"
#include "io/node_groups.h"
#include "io/tet_mesh_formats.h"
#include "io/write_each.h"

namespace collarmesh::io {

namespace {

constexpr std::size_t large_field = 16, fields_on_line = 8;

/// Formats a real number with a point and as many digits as fit.
std::string real(double value) {
  for (int digits = 17;; --digits) {
    std::string text = digits == 17 ? fmt::format("{}", value) : fmt::format("{:.{}g}", value, digits);
    if (text.find('.') == std::string::npos) text.insert(std::min(text.find('e'), text.size()), 1, '.');
    if (text.size() > large_field) continue;
    std::replace(text.begin(), text.end(), 'e', 'E');
    return text;
  }
}

void write_nodes(FileWriter& out, const TetMesh& mesh) {
  write_each(out, mesh.points.size(), [&](TextBuffer& text, std::size_t i) {
    const Point& p = mesh.points[i];
    text << std::string_view(fmt::format("GRID*   {:16}{:16}{:>16}{:>16}*\n*       {:>16}\n", i + 1, "",
                                         real(p.x), real(p.y), real(p.z)));
  });
}

/// Writes fields of eight characters, on continuation lines if there are more than eight.
template <class NodesOf>
void write_elements(FileWriter& out, const TetMesh& mesh, const char* name, std::size_t count,
                    std::size_t first, const NodesOf& nodes_of, const auto& property_of) {
  write_each(out, count, [&](TextBuffer& text, std::size_t i) {
    std::string line = fmt::format("{:8}{:8}{:8}", name, first + i, property_of(i));
    std::size_t fields = 2;
    for (const Index v : nodes_of(mesh, i)) {
      if (fields == fields_on_line) {
        line += "+\n+       ";
        fields = 0;
      }
      line += fmt::format("{:8}", v + 1);
      ++fields;
    }
    text << std::string_view(line) << '\n';
  });
}

}  // namespace

void write_nastran(const std::string& path, const TetMesh& mesh) {
  std::map<Index, Tag> regions;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) regions.try_emplace(mesh.tet_region[t], mesh.tet_tag[t]);
  const std::size_t last = regions.empty() ? 0 : regions.rbegin()->first;
  const std::map<Tag, std::size_t> patches = numbered_tags(mesh.face_tag, last + 1);
  FileWriter out(path);
  out << "$ Written by collarmesh.\nBEGIN BULK\n";
  for (const auto& [region, tag] : regions)
    out << fmt::format("$HMNAME PROP {:>19}\"{}\"\n", region, group_name(mesh, 3, tag));
  for (const auto& [tag, number] : patches)
    out << fmt::format("$HMNAME PROP {:>19}\"{}\"\n", number, group_name(mesh, 2, tag));
  write_nodes(out, mesh);
  write_elements(out, mesh, "CTETRA", mesh.tets.size(), 1, nodes_of_tet,
                 [&](std::size_t i) { return mesh.tet_region[i]; });
  write_elements(out, mesh, mesh.order() == 2 ? "CTRIA6" : "CTRIA3", mesh.faces.size(), mesh.tets.size() + 1,
                 nodes_of_face, [&](std::size_t i) { return patches.at(mesh.face_tag[i]); });
  out << "ENDDATA\n";
  out.commit();
}

}  // namespace collarmesh::io
