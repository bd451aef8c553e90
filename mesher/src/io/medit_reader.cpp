// Reads Medit's text format: vertices, tetrahedra, triangles and edges with their references;
// keywords that say nothing about those are skipped.
#include <fmt/format.h>

#include <array>
#include <string_view>
#include <vector>

#include "collarmesh/error.h"
#include "io/complete_mesh.h"
#include "io/file_bytes.h"
#include "io/medit_format.h"
#include "io/tet_mesh_formats.h"
#include "io/text_scanner.h"

namespace collarmesh::io {

namespace {

bool is_keyword(std::string_view word) {
  return !word.empty() && ((word[0] >= 'A' && word[0] <= 'Z') || (word[0] >= 'a' && word[0] <= 'z'));
}

void skip_numbers(TextScanner& scan) {
  while (!scan.at_end() && !is_keyword(scan.peek())) scan.word("a number");
}

void read_vertices(TextScanner& scan, TetMesh& mesh) {
  const Index n = scan.count("the number of vertices", 8);
  mesh.points.reserve(n);
  for (Index i = 0; i < n; ++i) {
    mesh.points.push_back(scan.point("a coordinate of a vertex"));
    scan.number("the reference of a vertex");
  }
}

template <std::size_t corners>
void read_cells(TextScanner& scan, std::string_view what, std::vector<std::array<Index, corners>>& cells,
                std::vector<Tag>& references, std::size_t point_count) {
  const Index n = scan.count(fmt::format("the number of {}", what), 2 * (corners + 1));
  cells.reserve(cells.size() + n);
  references.reserve(references.size() + n);
  for (Index i = 0; i < n; ++i) {
    std::array<Index, corners>& cell = cells.emplace_back();
    for (Index& corner : cell) corner = scan.index("a corner", 1, point_count);
    references.push_back(scan.integer("a reference"));
  }
}

void refuse_cells(TextScanner& scan, std::string_view keyword) {
  if (scan.count("the number of cells", 2) > 0)
    scan.fail(fmt::format("{} are not supported, only first-order tetrahedra and their triangles and edges",
                          keyword));
}

void require_three_dimensions(TextScanner& scan) {
  const std::int64_t dimension = scan.integer("the dimension");
  if (dimension != 3) scan.fail(fmt::format("the dimension is {}, but has to be 3", dimension));
}

bool is_unsupported_cell(std::string_view keyword) {
  for (const std::string_view kind : {"Hexahedra", "Hexaedra", "Prisms", "Pyramids", "Quadrilaterals",
                                      "TetrahedraP2", "TrianglesP2", "EdgesP2"})
    if (keyword == kind) return true;
  return false;
}

/// Returns false at the end of the mesh.
bool read_section(TextScanner& scan, TetMesh& mesh) {
  const std::string_view keyword = scan.word("a keyword or End");
  if (!is_keyword(keyword)) scan.fail("a keyword", keyword);
  if (keyword == "End") return false;
  if (keyword == "MeshVersionFormatted")
    scan.integer("a version");
  else if (keyword == "Dimension")
    require_three_dimensions(scan);
  else if (keyword == "Vertices")
    read_vertices(scan, mesh);
  else if (keyword == "Tetrahedra")
    read_cells(scan, "tetrahedra", mesh.tets, mesh.tet_tag, mesh.points.size());
  else if (keyword == "Triangles")
    read_cells(scan, "triangles", mesh.faces, mesh.face_tag, mesh.points.size());
  else if (keyword == "Edges")
    read_cells(scan, "edges", mesh.edges, mesh.edge_tag, mesh.points.size());
  else if (is_unsupported_cell(keyword))
    refuse_cells(scan, keyword);
  else
    skip_numbers(scan);
  return true;
}

}  // namespace

TetMesh read_medit(const std::string& path) {
  const std::string text = read_bytes(path);
  TextScanner scan(path, text);
  if (const std::string_view first = scan.peek(); first != "MeshVersionFormatted")
    scan.fail("MeshVersionFormatted", first);
  TetMesh mesh;
  while (!scan.at_end() && read_section(scan, mesh)) {
  }
  if (mesh.tets.empty()) scan.fail("expected tetrahedra, found none");
  // Ours refer to the region itself, of others only the order is known.
  if (text.starts_with(medit_signature)) mesh.tet_region.assign(mesh.tet_tag.begin(), mesh.tet_tag.end());
  complete_mesh(mesh);
  return mesh;
}

}  // namespace collarmesh::io
