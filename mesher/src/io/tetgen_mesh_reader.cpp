// Reads TetGen's mesh of first or second order: NAME.node and NAME.ele, and NAME.face and NAME.edge if they
// exist.
#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "io/cell_nodes.h"
#include "io/complete_mesh.h"
#include "io/file_bytes.h"
#include "io/tet_mesh_formats.h"
#include "io/tetgen_mesh_format.h"
#include "io/tetgen_nodes.h"
#include "io/text_scanner.h"

namespace collarmesh::io {

namespace {

class CellFile {
 public:
  CellFile(const std::string& path, std::int64_t first, std::size_t points)
      : path_(path), text_(read_bytes(path_)), scan_(path_, text_), first_(first), points_(points) {
    count_ = scan_.count("the number of cells", 4);
  }

  Index count() const { return count_; }
  TextScanner& scan() { return scan_; }

  CellNodes read_nodes(std::size_t n, std::span<const std::uint8_t> order) {
    scan_.integer("the number of a cell");
    CellNodes nodes;
    for (std::size_t k = 0; k < n; ++k) nodes.add(scan_.index("a corner", first_, points_));
    return nodes.from_order(order);
  }

  /// Reads a tag, which may be written as a real number, as attributes of regions are.
  Tag read_tag() {
    if (scan_.at_line_end()) return 0;
    const double value = scan_.coordinate("a marker or attribute");
    if (std::abs(value) >= 0x1p62) scan_.fail(fmt::format("the attribute {} is too large", value));
    return std::llround(value);
  }

 private:
  std::string path_, text_;
  TextScanner scan_;
  std::int64_t first_;
  std::size_t points_;
  Index count_ = 0;
};

std::int64_t read_nodes(const std::string& path, TetMesh& mesh) {
  const std::string text = read_bytes(path);
  TextScanner scan(path, text);
  std::vector<Tag> markers;  // not used, because their meaning differs between files
  return read_tetgen_nodes(scan, read_tetgen_node_header(scan), mesh.points, markers);
}

void read_tets(const std::string& path, std::int64_t first, TetMesh& mesh) {
  CellFile file(path, first, mesh.points.size());
  const std::int64_t n = file.scan().integer("the number of nodes of a tetrahedron");
  if (n != 4 && n != 10)
    file.scan().fail(fmt::format("tetrahedra have {} nodes, but have to have 4 or 10", n));
  const std::int64_t attributes =
      file.scan().at_line_end() ? 0 : file.scan().integer("the number of attributes");
  file.scan().skip_line();
  for (Index i = 0; i < file.count(); ++i) {
    add_cell(CellKind::tet, file.read_nodes(static_cast<std::size_t>(n), tetgen_tet_order), mesh);
    mesh.tet_tag.push_back(attributes > 0 ? file.read_tag() : 0);
    file.scan().skip_line();
  }
  if (mesh.tets.empty()) file.scan().fail("expected tetrahedra, found none");
}

/// Reads faces or edges, if their file exists. They have mid-edge nodes if the tets have.
void read_cells(const std::string& path, std::int64_t first, CellKind kind,
                std::span<const std::uint8_t> order, TetMesh& mesh) {
  if (!std::filesystem::exists(path)) return;
  CellFile file(path, first, mesh.points.size());
  const bool markers = !file.scan().at_line_end() && file.scan().integer("the flag for markers") != 0;
  file.scan().skip_line();
  for (Index i = 0; i < file.count(); ++i) {
    add_cell(kind, file.read_nodes(shape_of(kind).nodes(mesh.order()), order), mesh);
    tags_of(mesh, kind).push_back(markers ? file.read_tag() : 0);
    file.scan().skip_line();
  }
}

}  // namespace

TetMesh read_tetgen(const std::string& path) {
  TetMesh mesh;
  const std::int64_t first = read_nodes(tetgen_sibling(path, ".node"), mesh);
  read_tets(tetgen_sibling(path, ".ele"), first, mesh);
  read_cells(tetgen_sibling(path, ".face"), first, CellKind::triangle, tetgen_face_order, mesh);
  read_cells(tetgen_sibling(path, ".edge"), first, CellKind::edge, {}, mesh);
  complete_mesh(path, mesh);
  return mesh;
}

}  // namespace collarmesh::io
