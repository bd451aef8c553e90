// TetGen's mesh: NAME.ele and beside it NAME.node, NAME.face and NAME.edge, numbered from 1. The attribute of
// a tet is the tag of its region, the markers of faces and edges are their tags, the marker of a point is one
// more than the dimension of its feature, or 0 if that is unknown.
#include <filesystem>
#include <span>
#include <vector>

#include "io/cell_nodes.h"
#include "io/tet_mesh_formats.h"
#include "io/tetgen_mesh_format.h"
#include "io/write_each.h"

namespace collarmesh::io {

namespace {

void write_mesh_nodes(FileWriter& out, const TetMesh& mesh) {
  out << mesh.points.size() << " 3 0 1\n";
  write_each(out, mesh.points.size(), [&](TextBuffer& text, std::size_t i) {
    text << i + 1 << ' ' << mesh.points[i] << ' '
         << (mesh.features.empty() ? 0 : mesh.features[i].dimension + 1) << '\n';
  });
}

/// Writes number, nodes and tag of each cell. `order`: TetMesh's node at each place in second order; empty:
/// TetMesh's own order.
template <class NodesOf>
void write_cells(FileWriter& out, const TetMesh& mesh, const std::vector<Tag>& tags,
                 std::span<const std::uint8_t> order, NodesOf nodes_of) {
  write_each(out, tags.size(), [&](TextBuffer& text, std::size_t i) {
    text << i + 1;
    for (const Index v : nodes_of(mesh, i).in_order(order)) text << ' ' << std::size_t{v} + 1;
    text << ' ' << tags[i] << '\n';
  });
}

}  // namespace

std::string tetgen_sibling(const std::string& path, const char* extension) {
  return std::filesystem::path(path).replace_extension(extension).string();
}

void write_tetgen(const std::string& path, const TetMesh& mesh) {
  FileWriter nodes(tetgen_sibling(path, ".node")), tets(tetgen_sibling(path, ".ele")),
      faces(tetgen_sibling(path, ".face")), edges(tetgen_sibling(path, ".edge"));
  write_mesh_nodes(nodes, mesh);
  tets << mesh.tets.size() << (mesh.order() == 2 ? " 10 1\n" : " 4 1\n");
  write_cells(tets, mesh, mesh.tet_tag, tetgen_tet_order, nodes_of_tet);
  faces << mesh.faces.size() << " 1\n";
  write_cells(faces, mesh, mesh.face_tag, tetgen_face_order, nodes_of_face);
  edges << mesh.edges.size() << " 1\n";
  write_cells(edges, mesh, mesh.edge_tag, {}, nodes_of_edge);
  nodes.commit();
  faces.commit();
  edges.commit();
  tets.commit();
}

}  // namespace collarmesh::io
