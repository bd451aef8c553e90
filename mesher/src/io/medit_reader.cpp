// Reads Medit's text format: vertices, tetrahedra, triangles and edges with their references; skips other
// keywords.
#include <fmt/format.h>

#include <string_view>
#include <vector>

#include "collarmesh/error.h"
#include "io/cell_nodes.h"
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

/// Reads cells of this many nodes, which `add` puts into the mesh.
template <class Add>
void read_cells(TextScanner& scan, std::string_view what, std::size_t node_count, Add add,
                std::vector<Tag>& references, TetMesh& mesh) {
  const Index n = scan.count(fmt::format("the number of {}", what), 2 * (node_count + 1));
  references.reserve(references.size() + n);
  for (Index i = 0; i < n; ++i) {
    CellNodes nodes;
    for (std::size_t k = 0; k < node_count; ++k) nodes.add(scan.index("a corner", 1, mesh.points.size()));
    add(nodes, mesh);
    references.push_back(scan.integer("a reference"));
  }
}

void refuse_cells(TextScanner& scan, std::string_view keyword) {
  if (scan.count("the number of cells", 2) > 0)
    scan.fail(fmt::format("{} are not supported, only tetrahedra and their triangles and edges", keyword));
}

void require_three_dimensions(TextScanner& scan) {
  const std::int64_t dimension = scan.integer("the dimension");
  if (dimension != 3) scan.fail(fmt::format("the dimension is {}, but has to be 3", dimension));
}

bool is_unsupported_cell(std::string_view keyword) {
  for (const std::string_view kind : {"Hexahedra", "Hexaedra", "Prisms", "Pyramids", "Quadrilaterals"})
    if (keyword == kind) return true;
  return false;
}

/// Reads a section. Returns false at the end of the mesh.
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
  else if (keyword == "Tetrahedra" || keyword == "TetrahedraP2")
    read_cells(scan, "tetrahedra", keyword == "Tetrahedra" ? 4 : 10, add_tet, mesh.tet_tag, mesh);
  else if (keyword == "Triangles" || keyword == "TrianglesP2")
    read_cells(scan, "triangles", keyword == "Triangles" ? 3 : 6, add_face, mesh.face_tag, mesh);
  else if (keyword == "Edges" || keyword == "EdgesP2")
    read_cells(scan, "edges", keyword == "Edges" ? 2 : 3, add_edge, mesh.edge_tag, mesh);
  else if (is_unsupported_cell(keyword))
    refuse_cells(scan, keyword);
  else
    skip_numbers(scan);
  return true;
}

}  // namespace

namespace {

TetMesh read(const std::string& path, bool needs_tets) {
  const std::string text = read_bytes(path);
  TextScanner scan(path, text);
  if (const std::string_view first = scan.peek(); first != "MeshVersionFormatted")
    scan.fail("MeshVersionFormatted", first);
  TetMesh mesh;
  while (!scan.at_end() && read_section(scan, mesh)) {
  }
  if (needs_tets && mesh.tets.empty()) scan.fail("expected tetrahedra, found none");
  // In our files references are region indices; in others only their order is known.
  if (text.starts_with(medit_signature)) mesh.tet_region.assign(mesh.tet_tag.begin(), mesh.tet_tag.end());
  complete_mesh(path, mesh);
  return mesh;
}

}  // namespace

TetMesh read_medit(const std::string& path) { return read(path, true); }
TetMesh read_medit_cells(const std::string& path) { return read(path, false); }

}  // namespace collarmesh::io
