#pragma once

#include <array>
#include <cstdint>
#include <span>

namespace collarmesh {

/// The kinds of cells in the order in which formats list them: cells with a volume first.
enum class CellKind : std::uint8_t { tet, prism, pyramid, triangle, quadrangle, edge };

inline constexpr std::size_t cell_kinds = 6;
inline constexpr std::array<CellKind, cell_kinds> all_cell_kinds{CellKind::tet,        CellKind::prism,
                                                                 CellKind::pyramid,    CellKind::triangle,
                                                                 CellKind::quadrangle, CellKind::edge};
inline constexpr std::size_t most_nodes_of_cell = 15;

/// Positions of the ends of an edge among the corners of its cell.
using EdgePlaces = std::array<std::uint8_t, 2>;
/// Positions of the corners of a side among the corners of its cell, counterclockwise as seen from outside.
/// For a triangle the fourth one has no meaning.
struct SidePlaces {
  std::size_t corners;
  std::array<std::uint8_t, 4> places;
};

namespace cell_shapes {
inline constexpr std::array<EdgePlaces, 6> tet_edges{{{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}};
/// The edges of a tet in lexicographic order, the corner with the lower position first.
inline constexpr std::array<EdgePlaces, 6> corner_pairs{{{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};
inline constexpr std::array<EdgePlaces, 9> prism_edges{
    {{0, 1}, {1, 2}, {2, 0}, {3, 4}, {4, 5}, {5, 3}, {0, 3}, {1, 4}, {2, 5}}};
inline constexpr std::array<EdgePlaces, 8> pyramid_edges{
    {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {0, 4}, {1, 4}, {2, 4}, {3, 4}}};
inline constexpr std::array<EdgePlaces, 4> quadrangle_edges{{{0, 1}, {1, 2}, {2, 3}, {3, 0}}};
/// The side of a tet opposite each corner.
inline constexpr std::array<SidePlaces, 4> tet_sides{
    {{3, {1, 2, 3}}, {3, {0, 3, 2}}, {3, {0, 1, 3}}, {3, {0, 2, 1}}}};
inline constexpr std::array<SidePlaces, 5> prism_sides{
    {{3, {0, 2, 1}}, {3, {3, 4, 5}}, {4, {0, 1, 4, 3}}, {4, {1, 2, 5, 4}}, {4, {2, 0, 3, 5}}}};
inline constexpr std::array<SidePlaces, 5> pyramid_sides{
    {{4, {0, 3, 2, 1}}, {3, {0, 1, 4}}, {3, {1, 2, 4}}, {3, {2, 3, 4}}, {3, {3, 0, 4}}}};
}  // namespace cell_shapes

/// Corners, edges and sides of a kind of cells. In second order the mid-edge nodes follow the corners, in the
/// order of the edges.
struct CellShape {
  std::size_t dimension, corners;
  std::span<const EdgePlaces> edges;
  std::span<const SidePlaces> sides;  ///< sides of a cell with a volume

  constexpr std::size_t nodes(int order) const { return order == 2 ? corners + edges.size() : corners; }
};

/// Returns the shape of a kind of cells, with corners and edges in the order of TetMesh and LayerCells.
constexpr CellShape shape_of(CellKind kind) {
  using namespace cell_shapes;
  switch (kind) {
    case CellKind::tet: return {3, 4, tet_edges, tet_sides};
    case CellKind::prism: return {3, 6, prism_edges, prism_sides};
    case CellKind::pyramid: return {3, 5, pyramid_edges, pyramid_sides};
    case CellKind::triangle: return {2, 3, std::span(tet_edges).first(3), {}};
    case CellKind::quadrangle: return {2, 4, quadrangle_edges, {}};
    default: return {1, 2, std::span(tet_edges).first(1), {}};
  }
}

/// Returns the position, among all nodes of a cell of second order, of the mid-edge node of the edge between
/// corners i and j.
constexpr std::size_t mid_node_place(const CellShape& shape, std::uint8_t i, std::uint8_t j) {
  for (std::size_t e = 0; e < shape.edges.size(); ++e)
    if ((shape.edges[e][0] == i && shape.edges[e][1] == j) ||
        (shape.edges[e][0] == j && shape.edges[e][1] == i))
      return shape.corners + e;
  return shape.corners;
}

}  // namespace collarmesh
