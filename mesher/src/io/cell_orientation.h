#pragma once

#include "collarmesh/tet_mesh.h"
#include "io/cell_nodes.h"

namespace collarmesh::io {

/// Returns six times the volume of a tet, prism or pyramid with straight edges; approximate if a quadrangle
/// is not planar.
double six_volume_of(const TetMesh& mesh, CellKind kind, std::size_t cell);

/// Returns a cell with the opposite orientation: a cell with volume turned inside out, a triangle or
/// quadrangle turned over.
CellNodes turned(CellKind kind, const CellNodes& nodes);

}  // namespace collarmesh::io
