#pragma once

#include <string_view>

#include "common/cell_shapes.h"

namespace collarmesh::io {

/// The first line of files that we write. In these files the reference of a three-dimensional cell is its
/// region's index.
constexpr std::string_view medit_signature = "# Written by collarmesh.\n";

/// Returns the keyword of a kind of cells of first order. For tets, triangles and edges of second order, P2
/// follows. The other kinds have no keyword for our second order: PrismsP2, PyramidsP2 and QuadrilateralsQ2
/// also have nodes on their faces.
constexpr std::string_view medit_keyword(CellKind kind) {
  switch (kind) {
    case CellKind::tet: return "Tetrahedra";
    case CellKind::prism: return "Prisms";
    case CellKind::pyramid: return "Pyramids";
    case CellKind::triangle: return "Triangles";
    case CellKind::quadrangle: return "Quadrilaterals";
    default: return "Edges";
  }
}

}  // namespace collarmesh::io
