// Medit's text format (.mesh; P. Frey, "MEDIT: an interactive mesh visualization software", 2001). The
// reference of a vertex is the dimension of its feature (0 if unknown), that of a volume its region, that of
// a face or edge its tag. The section Corners lists the vertices that are features, for remeshers to keep.
#include <algorithm>
#include <string_view>
#include <vector>

#include "io/cell_nodes.h"
#include "io/medit_format.h"
#include "io/tet_mesh_formats.h"
#include "io/write_each.h"

namespace collarmesh::io {

namespace {

/// Writes the cells of a kind with their regions or tags.
void write_cells(FileWriter& out, const TetMesh& mesh, CellKind kind) {
  if (count_of(mesh, kind) == 0) return;
  out << '\n' << medit_keyword(kind) << (mesh.order() == 2 ? "P2\n" : "\n") << count_of(mesh, kind) << '\n';
  const bool volume = shape_of(kind).dimension == 3;
  write_each(out, count_of(mesh, kind), [&](TextBuffer& text, std::size_t i) {
    for (const Index v : nodes_of(kind)(mesh, i)) text << std::size_t{v} + 1 << ' ';
    if (volume)
      text << features_of(mesh, kind)[i];
    else
      text << tags_of(mesh, kind)[i];
    text << '\n';
  });
}

void write_vertices(FileWriter& out, const TetMesh& mesh) {
  out << "\nVertices\n" << mesh.points.size() << '\n';
  write_each(out, mesh.points.size(), [&](TextBuffer& text, std::size_t v) {
    text << mesh.points[v] << ' ' << (mesh.features.empty() ? 0 : int{mesh.features[v].dimension}) << '\n';
  });
}

void write_corners(FileWriter& out, const TetMesh& mesh) {
  const auto is_corner = [](const TetMesh::VertexFeature& f) { return f.dimension == 0; };
  const auto count = std::count_if(mesh.features.begin(), mesh.features.end(), is_corner);
  if (count == 0) return;
  out << "\nCorners\n" << count << '\n';
  for (std::size_t v = 0; v < mesh.features.size(); ++v)
    if (is_corner(mesh.features[v])) out << v + 1 << '\n';
}

}  // namespace

void write_medit(const std::string& path, const TetMesh& mesh) {
  FileWriter out(path);
  out << medit_signature << "MeshVersionFormatted 2\n\nDimension 3\n";
  write_vertices(out, mesh);
  for (const CellKind kind : all_cell_kinds) write_cells(out, mesh, kind);
  write_corners(out, mesh);
  out << "\nEnd\n";
  out.commit();
}

}  // namespace collarmesh::io
