#include "io/cell_orientation.h"

#include <array>
#include <cstdint>
#include <span>

namespace collarmesh::io {

namespace {

// Entry k of a table is the node of a cell that becomes node k of the cell with the opposite orientation;
// corners come first.
constexpr std::array<std::uint8_t, 10> turned_tet{0, 1, 3, 2, 4, 8, 7, 6, 5, 9};
constexpr std::array<std::uint8_t, 15> prism{0, 2, 1, 3, 5, 4, 8, 7, 6, 11, 10, 9, 12, 14, 13};
constexpr std::array<std::uint8_t, 13> pyramid{0, 3, 2, 1, 4, 8, 7, 6, 5, 9, 12, 11, 10};
constexpr std::array<std::uint8_t, 6> turned_triangle{0, 2, 1, 5, 4, 3};
constexpr std::array<std::uint8_t, 8> quadrangle{0, 3, 2, 1, 7, 6, 5, 4};

constexpr std::span<const std::uint8_t> turned_places(CellKind kind) {
  switch (kind) {
    case CellKind::tet: return turned_tet;
    case CellKind::prism: return prism;
    case CellKind::pyramid: return pyramid;
    case CellKind::triangle: return turned_triangle;
    default: return quadrangle;
  }
}

}  // namespace

double six_volume_of(const TetMesh& mesh, CellKind kind, std::size_t cell) {
  const CellNodes n = nodes_of(kind)(mesh, cell);
  const auto of_tet = [&](std::size_t a, std::size_t b, std::size_t c, std::size_t d) {
    return six_volume(mesh.points[n[a]], mesh.points[n[b]], mesh.points[n[c]], mesh.points[n[d]]);
  };
  if (kind == CellKind::tet) return of_tet(0, 1, 2, 3);
  if (kind == CellKind::prism) return of_tet(0, 1, 2, 3) + of_tet(1, 2, 3, 4) + of_tet(2, 3, 4, 5);
  return of_tet(0, 1, 2, 4) + of_tet(0, 2, 3, 4);
}

CellNodes turned(CellKind kind, const CellNodes& nodes) {
  return nodes.in_order(turned_places(kind).first(nodes.size()));
}

}  // namespace collarmesh::io
