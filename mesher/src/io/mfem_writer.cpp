// MFEM's mesh format v1.0 (mfem.org/mesh-format-v1.0): tetrahedra with the number of their region as
// attribute, triangles with their tags, or numbered from 1 if not all tags are positive. Comments give the
// name of each attribute. Curved elements are a function of second order on the vertices and edges.
#include <fmt/format.h>

#include <array>
#include <map>
#include <numeric>
#include <string>
#include <vector>

#include "io/cell_nodes.h"
#include "io/label_names.h"
#include "io/node_groups.h"
#include "io/tet_mesh_formats.h"
#include "io/write_each.h"

namespace collarmesh::io {

namespace {

constexpr int triangle = 2, tetrahedron = 4;

/// The order of nodes: corners first, then mid-edge nodes in the order in which MFEM numbers edges: as they
/// appear, element by element.
struct Order {
  std::vector<Index> corner_number;  ///< by point; none: it is no corner
  std::vector<Index> corners, mid_nodes;

  explicit Order(const TetMesh& mesh) : corner_number(mesh.points.size(), none) {
    for (const auto& tet : mesh.tets)
      for (const Index v : tet) corner_number[v] = 0;
    for (const auto& face : mesh.faces)
      for (const Index v : face) corner_number[v] = 0;
    for (Index v = 0; v < corner_number.size(); ++v)
      if (corner_number[v] == 0) {
        corner_number[v] = static_cast<Index>(corners.size());
        corners.push_back(v);
      }
    // TetMesh's places of MFEM's edges ab, ac, ad, bc, bd, cd.
    constexpr std::array<std::size_t, 6> edges{0, 2, 3, 1, 4, 5};
    std::vector<bool> there(mesh.points.size(), false);
    for (const auto& middle : mesh.tet_mid_nodes)
      for (const std::size_t k : edges)
        if (!there[middle[k]]) {
          there[middle[k]] = true;
          mid_nodes.push_back(middle[k]);
        }
  }
};

void write_points(FileWriter& out, const TetMesh& mesh, const std::vector<Index>& which) {
  write_each(out, which.size(), [&](TextBuffer& text, std::size_t i) {
    const Point& p = mesh.points[which[i]];
    text << p.x << ' ' << p.y << ' ' << p.z << '\n';
  });
}

void write_names(FileWriter& out, const TetMesh& mesh, const std::map<Tag, std::size_t>& attributes) {
  std::map<Index, Tag> regions;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) regions.try_emplace(mesh.tet_region[t], mesh.tet_tag[t]);
  for (const auto& [region, tag] : regions)
    out << fmt::format("# attribute {}: {}\n", region, group_name(mesh, 3, tag));
  for (const auto& [tag, attribute] : attributes)
    out << fmt::format("# boundary attribute {}: {}\n", attribute, group_name(mesh, 2, tag));
}

/// Writes the elements with these numbers.
template <std::size_t n>
void write_cells(FileWriter& out, const std::vector<std::array<Index, n>>& cells,
                 const std::vector<Index>& which, const Order& order, int kind, const auto& attribute_of) {
  out << which.size() << '\n';
  write_each(out, which.size(), [&](TextBuffer& text, std::size_t i) {
    text << attribute_of(which[i]) << ' ' << kind;
    for (const Index v : cells[which[i]]) text << ' ' << order.corner_number[v];
    text << '\n';
  });
}

}  // namespace

void write_mfem(const std::string& path, const TetMesh& mesh) {
  const Order order(mesh);
  std::vector<Index> tets(mesh.tets.size()), faces;
  std::iota(tets.begin(), tets.end(), Index{0});
  for (Index f = 0; f < mesh.faces.size(); ++f)  // other faces bound nothing
    if (mesh.face_regions[f] != std::array<Index, 2>{0, 0}) faces.push_back(f);
  const std::map<Tag, std::size_t> attributes = positive_numbers(mesh.face_tag);
  FileWriter out(path);
  out << "MFEM mesh v1.0\n\n# Written by collarmesh.\n";
  write_names(out, mesh, attributes);
  out << "\ndimension\n3\n\nelements\n";
  write_cells(out, mesh.tets, tets, order, tetrahedron, [&](std::size_t i) { return mesh.tet_region[i]; });
  out << "\nboundary\n";
  write_cells(out, mesh.faces, faces, order, triangle,
              [&](std::size_t i) { return attributes.at(mesh.face_tag[i]); });
  out << "\nvertices\n" << order.corners.size() << '\n';
  if (mesh.order() == 1) {
    out << "3\n";
    write_points(out, mesh, order.corners);
  } else {
    out << "\nnodes\nFiniteElementSpace\nFiniteElementCollection: H1_3D_P2\nVDim: 3\nOrdering: 1\n\n";
    write_points(out, mesh, order.corners);
    write_points(out, mesh, order.mid_nodes);
  }
  out.commit();
}

}  // namespace collarmesh::io
