// MFEM's mesh format v1.0 (mfem.org/mesh-format-v1.0): volumes with the number of their region as attribute,
// faces with their tags, or with numbers from 1 if a tag is not a positive number of 32 bits. Comments in the
// file give the name of each attribute. The geometry of second order is a function with values at vertices
// and mid-edge nodes.
#include <fmt/format.h>

#include <array>
#include <map>
#include <string>
#include <vector>

#include "io/cell_nodes.h"
#include "io/label_names.h"
#include "io/node_groups.h"
#include "io/tet_mesh_formats.h"
#include "io/write_each.h"

namespace collarmesh::io {

namespace {

/// Returns MFEM's number of a kind of cells.
constexpr int geometry_of(CellKind kind) {
  switch (kind) {
    case CellKind::tet: return 4;
    case CellKind::prism: return 6;
    case CellKind::pyramid: return 7;
    case CellKind::quadrangle: return 3;
    default: return 2;
  }
}

/// The order of nodes in the file: corners first, then mid-edge nodes in the order of MFEM's edges, which
/// MFEM numbers as they appear, element by element.
struct Order {
  std::vector<Index> corner_number;  ///< by point; none: it is no corner
  std::vector<Index> corners, mid_nodes;

  explicit Order(const TetMesh& mesh) : corner_number(mesh.points.size(), none) {
    for (const std::size_t dimension : {2, 3})
      for_each_kind(mesh, dimension, [&](CellKind kind) { mark_corners(mesh, kind); });
    for (Index v = 0; v < corner_number.size(); ++v)
      if (corner_number[v] == 0) {
        corner_number[v] = static_cast<Index>(corners.size());
        corners.push_back(v);
      }
    // The place in TetMesh of each of MFEM's edges ab, ac, ad, bc, bd, cd.
    constexpr std::array<std::size_t, 6> edges{0, 2, 3, 1, 4, 5};
    std::vector<bool> there(mesh.points.size(), false);
    for (const auto& middle : mesh.tet_mid_nodes)
      for (const std::size_t k : edges)
        if (!there[middle[k]]) {
          there[middle[k]] = true;
          mid_nodes.push_back(middle[k]);
        }
  }

 private:
  void mark_corners(const TetMesh& mesh, CellKind kind) {
    const std::size_t corners_of_cell = shape_of(kind).corners;
    for (std::size_t i = 0; i < count_of(mesh, kind); ++i) {
      const CellNodes nodes = nodes_of(kind)(mesh, i);
      for (std::size_t k = 0; k < corners_of_cell; ++k) corner_number[nodes[k]] = 0;
    }
  }
};

void write_points(FileWriter& out, const TetMesh& mesh, const std::vector<Index>& which) {
  write_each(out, which.size(),
             [&](TextBuffer& text, std::size_t i) { text << mesh.points[which[i]] << '\n'; });
}

void write_names(FileWriter& out, const TetMesh& mesh, const std::map<Tag, std::size_t>& attributes) {
  for (const auto& [region, tag] : tags_of_regions(mesh))
    out << fmt::format("# attribute {}: {}\n", region, group_name(mesh, 3, tag));
  for (const auto& [tag, attribute] : attributes)
    out << fmt::format("# boundary attribute {}: {}\n", attribute, group_name(mesh, 2, tag));
}

/// A cell and the attribute it gets.
struct Attributed {
  CellKind kind;
  Index cell;
  std::size_t attribute;
};

void write_cells(FileWriter& out, const TetMesh& mesh, const std::vector<Attributed>& cells,
                 const Order& order) {
  out << cells.size() << '\n';
  write_each(out, cells.size(), [&](TextBuffer& text, std::size_t i) {
    const auto& [kind, cell, attribute] = cells[i];
    text << attribute << ' ' << geometry_of(kind);
    const CellNodes nodes = nodes_of(kind)(mesh, cell);
    for (std::size_t k = 0; k < shape_of(kind).corners; ++k) text << ' ' << order.corner_number[nodes[k]];
    text << '\n';
  });
}

}  // namespace

void write_mfem(const std::string& path, const TetMesh& mesh) {
  const Order order(mesh);
  const std::map<Tag, std::size_t> attributes = positive_numbers(all_tags(mesh, 2));
  std::vector<Attributed> volumes, faces;
  for_each_kind(mesh, 3, [&](CellKind kind) {
    for (Index i = 0; i < count_of(mesh, kind); ++i) volumes.push_back({kind, i, features_of(mesh, kind)[i]});
  });
  for_each_kind(mesh, 2, [&](CellKind kind) {
    for (Index f = 0; f < count_of(mesh, kind); ++f)  // a face beside no region bounds nothing
      if (regions_beside(mesh, kind)[f] != std::array<Index, 2>{0, 0})
        faces.push_back({kind, f, attributes.at(tags_of(mesh, kind)[f])});
  });
  FileWriter out(path);
  out << "MFEM mesh v1.0\n\n# Written by collarmesh.\n";
  write_names(out, mesh, attributes);
  out << "\ndimension\n3\n\nelements\n";
  write_cells(out, mesh, volumes, order);
  out << "\nboundary\n";
  write_cells(out, mesh, faces, order);
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
