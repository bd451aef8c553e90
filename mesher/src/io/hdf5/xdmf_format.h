#pragma once

#include <array>
#include <string_view>

#include "common/cell_shapes.h"

namespace collarmesh::io {

/// XDMF's names of a kind of cells, by order.
struct XdmfTopology {
  CellKind kind;
  std::array<std::string_view, 2> names;
};
constexpr std::array<XdmfTopology, 3> xdmf_topologies{{{CellKind::tet, {"Tetrahedron", "Tetrahedron_10"}},
                                                       {CellKind::triangle, {"Triangle", "Triangle_6"}},
                                                       {CellKind::edge, {"Polyline", "Edge_3"}}}};

}  // namespace collarmesh::io
