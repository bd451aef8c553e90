// Reads Medit's text format: vertices, tetrahedra, prisms, pyramids, triangles, quadrilaterals and edges with
// their references; rejects other cells and skips other keywords.
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

/// Reads the cells of a kind with their references.
void read_cells(TextScanner& scan, CellKind kind, int order, TetMesh& mesh) {
  const std::size_t node_count = shape_of(kind).nodes(order);
  const Index n = scan.count(fmt::format("the number of {}", medit_keyword(kind)), 2 * (node_count + 1));
  for (Index i = 0; i < n; ++i) {
    CellNodes nodes;
    for (std::size_t k = 0; k < node_count; ++k) nodes.add(scan.index("a corner", 1, mesh.points.size()));
    add_cell(kind, nodes, mesh);
    tags_of(mesh, kind).push_back(scan.integer("a reference"));
  }
}

/// Reads cells if the keyword is of a kind that is supported. Returns whether it is.
bool read_cells(TextScanner& scan, std::string_view keyword, TetMesh& mesh) {
  for (const CellKind kind : all_cell_kinds) {
    const bool simplex = kind == CellKind::tet || kind == CellKind::triangle || kind == CellKind::edge;
    for (const int order : {1, 2}) {
      if (order == 2 && !simplex) continue;
      if (keyword != fmt::format("{}{}", medit_keyword(kind), order == 2 ? "P2" : "")) continue;
      read_cells(scan, kind, order, mesh);
      return true;
    }
  }
  return false;
}

void refuse_cells(TextScanner& scan, std::string_view keyword) {
  if (scan.count("the number of cells", 2) > 0)
    scan.fail(
        fmt::format("{} are not supported, only tetrahedra, triangles and edges, and prisms, pyramids and "
                    "quadrilaterals of first order",
                    keyword));
}

void require_three_dimensions(TextScanner& scan) {
  const std::int64_t dimension = scan.integer("the dimension");
  if (dimension != 3) scan.fail(fmt::format("the dimension is {}, but has to be 3", dimension));
}

bool is_unsupported_cell(std::string_view keyword) {
  for (const std::string_view kind : {"Hexahedra", "Hexaedra", "PrismsP2", "PyramidsP2", "QuadrilateralsQ2"})
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
  else if (read_cells(scan, keyword, mesh))
    return true;
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
  // In our files references are region indices. For others, `complete_mesh` numbers regions by ascending
  // reference.
  if (text.starts_with(medit_signature))
    for_each_kind(mesh, 3, [&](CellKind kind) {
      features_of(mesh, kind).assign(tags_of(mesh, kind).begin(), tags_of(mesh, kind).end());
    });
  complete_mesh(path, mesh);
  return mesh;
}

}  // namespace

TetMesh read_medit(const std::string& path) { return read(path, true); }
TetMesh read_medit_cells(const std::string& path) { return read(path, false); }

}  // namespace collarmesh::io
