// Nastran's bulk data (.bdf; MSC Nastran Quick Reference Guide): nodes in large fields, CTETRA, CPENTA and
// CPYRAM of both orders, CTRIA3 or CTRIA6 and CQUAD4 or CQUAD8 for the faces. Each region has a property
// number, and so has each tag of faces, with numbers after those of the regions; comments give their names,
// as HyperMesh does. The user adds properties and materials, and deletes faces that need none.
#include <fmt/format.h>

#include <algorithm>
#include <array>
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

/// Formats a real number with a decimal point and as many digits as fit.
std::string short_real(double value) {
  for (int digits = 17;; --digits) {
    std::string text = digits == 17 ? fmt::format("{}", value) : fmt::format("{:.{}g}", value, digits);
    if (text.find('.') == std::string::npos) text.insert(std::min(text.find('e'), text.size()), 1, '.');
    if (text.size() > large_field) continue;
    std::replace(text.begin(), text.end(), 'e', 'E');
    return text;
  }
}

void write_grid_points(FileWriter& out, const TetMesh& mesh) {
  write_each(out, mesh.points.size(), [&](TextBuffer& text, std::size_t i) {
    const Point& p = mesh.points[i];
    text << std::string_view(fmt::format("GRID*   {:16}{:16}{:>16}{:>16}*\n*       {:>16}\n", i + 1, "",
                                         short_real(p.x), short_real(p.y), short_real(p.z)));
  });
}

/// Returns the names of the elements for a kind of cells, by order.
constexpr std::array<const char*, 2> nastran_names_of(CellKind kind) {
  switch (kind) {
    case CellKind::tet: return {"CTETRA", "CTETRA"};
    case CellKind::prism: return {"CPENTA", "CPENTA"};
    case CellKind::pyramid: return {"CPYRAM", "CPYRAM"};
    case CellKind::quadrangle: return {"CQUAD4", "CQUAD8"};
    default: return {"CTRIA3", "CTRIA6"};
  }
}

/// Writes elements in fields of eight characters. Continuation lines take the fields after the eighth.
void write_elements(FileWriter& out, const TetMesh& mesh, CellKind kind, const auto& property_of) {
  const char* const name = nastran_names_of(kind)[mesh.order() == 2 ? 1 : 0];
  const std::size_t first = count_before(mesh, kind) + 1;
  write_each(out, count_of(mesh, kind), [&](TextBuffer& text, std::size_t i) {
    std::string line = fmt::format("{:8}{:8}{:8}", name, first + i, property_of(i));
    std::size_t fields = 2;
    for (const Index v : with_between_before_top(kind, nodes_of(kind)(mesh, i))) {
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
  const std::map<Index, Tag> regions = tags_of_regions(mesh);
  const std::size_t last = regions.empty() ? 0 : regions.rbegin()->first;
  const std::map<Tag, std::size_t> patches = numbered_tags(all_tags(mesh, 2), last + 1);
  FileWriter out(path);
  out << "$ Written by collarmesh.\nBEGIN BULK\n";
  for (const auto& [region, tag] : regions)
    out << fmt::format("$HMNAME PROP {:>19}\"{}\"\n", region, group_name(mesh, 3, tag));
  for (const auto& [tag, number] : patches)
    out << fmt::format("$HMNAME PROP {:>19}\"{}\"\n", number, group_name(mesh, 2, tag));
  write_grid_points(out, mesh);
  for_each_kind(mesh, 3, [&](CellKind kind) {
    write_elements(out, mesh, kind, [&](std::size_t i) { return features_of(mesh, kind)[i]; });
  });
  for_each_kind(mesh, 2, [&](CellKind kind) {
    write_elements(out, mesh, kind, [&](std::size_t i) { return patches.at(tags_of(mesh, kind)[i]); });
  });
  out << "ENDDATA\n";
  out.commit();
}

}  // namespace collarmesh::io
