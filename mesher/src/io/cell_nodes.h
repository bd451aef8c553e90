#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <type_traits>
#include <vector>

#include "collarmesh/tet_mesh.h"
#include "common/cell_shapes.h"

namespace collarmesh::io {

/// An item for each kind of cells.
template <class Item>
struct PerKind : std::array<Item, cell_kinds> {
  constexpr Item& operator[](CellKind kind) { return this->data()[static_cast<std::size_t>(kind)]; }
  constexpr const Item& operator[](CellKind kind) const {
    return this->data()[static_cast<std::size_t>(kind)];
  }
};

/// Returns the mid-edge nodes of a cell as a span: an edge stores one index, other cells an array.
template <class Nodes>
auto as_span(Nodes& nodes) {
  if constexpr (std::is_same_v<std::remove_const_t<Nodes>, Index>)
    return std::span<Nodes, 1>(&nodes, 1);
  else
    return std::span(nodes);
}

/// The nodes of a cell of either order: its corners, then its mid-edge nodes in the order of TetMesh and
/// LayerCells (tets: ab, bc, ca, ad, bd, cd). VTK, Abaqus and Medit have the same order for tets.
class CellNodes {
 public:
  template <class Cell, class Middle>
  static CellNodes of(const Cell& cell, const std::vector<Middle>& middle, std::size_t i) {
    CellNodes result;
    for (const Index v : cell) result.add(v);
    if (!middle.empty())
      for (const Index v : as_span(middle[i])) result.add(v);
    return result;
  }

  void add(Index node) { nodes_[count_++] = node; }
  /// Returns a cell whose k-th node is this cell's node order[k], or this cell if the order has another
  /// length.
  CellNodes in_order(std::span<const std::uint8_t> order) const {
    if (order.size() != count_) return *this;
    CellNodes result;
    for (const std::uint8_t k : order) result.add(nodes_[k]);
    return result;
  }
  /// Returns the cell whose node order[k] is this cell's k-th node, or this cell if the order has another
  /// length.
  CellNodes from_order(std::span<const std::uint8_t> order) const {
    if (order.size() != count_) return *this;
    CellNodes result = *this;
    for (std::size_t k = 0; k < count_; ++k) result.nodes_[order[k]] = nodes_[k];
    return result;
  }
  /// Returns the cell whose node order[k] is listed[k]. The order may name a node several times, as for a
  /// pyramid that a format stores as a hexahedron; returns nothing if a node's entries in `listed` differ.
  static std::optional<CellNodes> gathered(std::span<const Index> listed,
                                           std::span<const std::uint8_t> order) {
    CellNodes result;
    for (const std::uint8_t k : order) result.count_ = std::max<std::uint8_t>(result.count_, k + 1);
    for (std::size_t k = 0; k < order.size(); ++k) result.nodes_[order[k]] = listed[k];
    for (std::size_t k = 0; k < order.size(); ++k)
      if (result.nodes_[order[k]] != listed[k]) return std::nullopt;
    return result;
  }

  std::size_t size() const { return count_; }
  const Index* begin() const { return nodes_.data(); }
  const Index* end() const { return nodes_.data() + count_; }
  Index operator[](std::size_t k) const { return nodes_[k]; }

 private:
  std::array<Index, most_nodes_of_cell> nodes_{};
  std::uint8_t count_ = 0;
};

// The arrays of a mesh by the kind of cells, for writers and readers that loop over the kinds.

/// Calls `call(cells, middle)` with the cells of a kind and their mid-edge nodes.
template <class Mesh, class Call>
auto with_cells(Mesh& mesh, CellKind kind, const Call& call) {
  switch (kind) {
    case CellKind::tet: return call(mesh.tets, mesh.tet_mid_nodes);
    case CellKind::prism: return call(mesh.layers.prisms, mesh.layers.prism_mid_nodes);
    case CellKind::pyramid: return call(mesh.layers.pyramids, mesh.layers.pyramid_mid_nodes);
    case CellKind::triangle: return call(mesh.faces, mesh.face_mid_nodes);
    case CellKind::quadrangle: return call(mesh.layers.quads, mesh.layers.quad_mid_nodes);
    default: return call(mesh.edges, mesh.edge_mid_nodes);
  }
}

inline std::size_t count_of(const TetMesh& mesh, CellKind kind) {
  return with_cells(mesh, kind, [](const auto& cells, const auto&) { return cells.size(); });
}

template <CellKind kind>
CellNodes nodes_of_kind(const TetMesh& mesh, std::size_t i) {
  return with_cells(
      mesh, kind, [i](const auto& cells, const auto& middle) { return CellNodes::of(cells[i], middle, i); });
}
using NodesOf = CellNodes (*)(const TetMesh&, std::size_t);
constexpr NodesOf nodes_of_tet = nodes_of_kind<CellKind::tet>,
                  nodes_of_face = nodes_of_kind<CellKind::triangle>,
                  nodes_of_edge = nodes_of_kind<CellKind::edge>;
constexpr NodesOf nodes_of(CellKind kind) {
  constexpr PerKind<NodesOf> of_kind{{nodes_of_tet, nodes_of_kind<CellKind::prism>,
                                      nodes_of_kind<CellKind::pyramid>, nodes_of_face,
                                      nodes_of_kind<CellKind::quadrangle>, nodes_of_edge}};
  return of_kind[kind];
}

/// Returns the tags of the cells of a kind. The result is const if the mesh is; this also holds for the
/// functions below.
template <class Mesh>
auto& tags_of(Mesh& mesh, CellKind kind) {
  switch (kind) {
    case CellKind::tet: return mesh.tet_tag;
    case CellKind::prism: return mesh.layers.prism_tag;
    case CellKind::pyramid: return mesh.layers.pyramid_tag;
    case CellKind::triangle: return mesh.face_tag;
    case CellKind::quadrangle: return mesh.layers.quad_tag;
    default: return mesh.edge_tag;
  }
}
/// Returns for each cell of a kind its feature: the region of a cell with volume, the patch of a triangle or
/// quadrangle, the curve of an edge.
template <class Mesh>
auto& features_of(Mesh& mesh, CellKind kind) {
  switch (kind) {
    case CellKind::tet: return mesh.tet_region;
    case CellKind::prism: return mesh.layers.prism_region;
    case CellKind::pyramid: return mesh.layers.pyramid_region;
    case CellKind::triangle: return mesh.face_patch;
    case CellKind::quadrangle: return mesh.layers.quad_patch;
    default: return mesh.edge_curve;
  }
}
/// Returns for each triangle, or each quadrangle, the regions behind and in front of it.
template <class Mesh>
auto& regions_beside(Mesh& mesh, CellKind kind) {
  return kind == CellKind::quadrangle ? mesh.layers.quad_regions : mesh.face_regions;
}
/// Returns for each cell of a kind with volume the number of its layer; for tets the list may be empty.
template <class Mesh>
auto& layers_of(Mesh& mesh, CellKind kind) {
  switch (kind) {
    case CellKind::prism: return mesh.layers.prism_layer;
    case CellKind::pyramid: return mesh.layers.pyramid_layer;
    default: return mesh.layers.tet_layer;
  }
}

/// Layer numbers read from files must be below this.
constexpr std::int64_t most_layers = 0x10000;

/// Returns the number of a cell's layer, 0 for a cell outside layers.
inline std::uint16_t layer_of(const TetMesh& mesh, CellKind kind, std::size_t i) {
  if (shape_of(kind).dimension < 3) return 0;
  const std::vector<std::uint16_t>& layers = layers_of(mesh, kind);
  return layers.empty() ? 0 : layers[i];
}

/// The order of a prism's nodes in CGNS, Exodus and Nastran, as our node at each place: the mid-edge nodes
/// between the two triangles come before those of the second triangle.
inline constexpr std::array<std::uint8_t, 15> prism_between_before_top{0, 1,  2,  3,  4, 5,  6, 7,
                                                                       8, 12, 13, 14, 9, 10, 11};
inline CellNodes with_between_before_top(CellKind kind, const CellNodes& nodes) {
  return kind == CellKind::prism ? nodes.in_order(prism_between_before_top) : nodes;
}

/// Calls `call(kind)` for each kind of cells of this dimension that occurs in the mesh.
template <class Call>
void for_each_kind(const TetMesh& mesh, std::size_t dimension, const Call& call) {
  for (const CellKind kind : all_cell_kinds)
    if (shape_of(kind).dimension == dimension && count_of(mesh, kind) > 0) call(kind);
}

/// Returns the number of cells of a dimension.
inline std::size_t count_of_dimension(const TetMesh& mesh, std::size_t dimension) {
  std::size_t count = 0;
  for_each_kind(mesh, dimension, [&](CellKind kind) { count += count_of(mesh, kind); });
  return count;
}
/// Returns the number of cells of all kinds that come before this one in `all_cell_kinds`.
inline std::size_t count_before(const TetMesh& mesh, CellKind kind) {
  std::size_t count = 0;
  for (const CellKind before : all_cell_kinds) {
    if (before == kind) break;
    count += count_of(mesh, before);
  }
  return count;
}

inline std::size_t count_of_all(const TetMesh& mesh) {
  return count_before(mesh, CellKind::edge) + mesh.edges.size();
}

/// Returns the tags of all cells of a dimension, in the order of the kinds.
inline std::vector<Tag> all_tags(const TetMesh& mesh, std::size_t dimension) {
  std::vector<Tag> tags;
  for_each_kind(mesh, dimension, [&](CellKind kind) {
    tags.insert(tags.end(), tags_of(mesh, kind).begin(), tags_of(mesh, kind).end());
  });
  return tags;
}

/// Replaces the nodes of the i-th cell of a kind, of either order.
inline void set_cell(CellKind kind, std::size_t i, const CellNodes& nodes, TetMesh& mesh) {
  with_cells(mesh, kind, [&](auto& cells, auto& middle) {
    const auto corners = cells[i].size();
    std::copy_n(nodes.begin(), corners, cells[i].begin());
    if (nodes.size() <= corners) return;
    const auto mids = as_span(middle[i]);
    std::copy_n(nodes.begin() + corners, mids.size(), mids.begin());
  });
}
/// Appends a cell of either order to a mesh that is being read.
inline void add_cell(CellKind kind, const CellNodes& nodes, TetMesh& mesh) {
  with_cells(mesh, kind, [&](auto& cells, auto& middle) {
    const auto corners = cells.emplace_back().size();
    std::copy_n(nodes.begin(), corners, cells.back().begin());
    if (nodes.size() <= corners) return;
    const auto mids = as_span(middle.emplace_back());
    std::copy_n(nodes.begin() + corners, mids.size(), mids.begin());
  });
}

/// Returns the nodes of a side of a cell: corners, then mid-edge nodes, both counterclockwise as seen from
/// outside.
inline CellNodes nodes_of_side(CellKind kind, const CellNodes& cell, std::size_t side) {
  const CellShape shape = shape_of(kind);
  const auto& [corners, places] = shape.sides[side];
  CellNodes result;
  for (std::size_t k = 0; k < corners; ++k) result.add(cell[places[k]]);
  if (cell.size() == shape.corners) return result;
  for (std::size_t k = 0; k < corners; ++k)
    result.add(cell[mid_node_place(shape, places[k], places[(k + 1) % corners])]);
  return result;
}

}  // namespace collarmesh::io
