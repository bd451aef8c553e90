#pragma once

#include <string>

#include "collarmesh/tet_mesh.h"

namespace collarmesh::io {

/// Completes a mesh read from a file so that it keeps the promises of TetMesh and LayerCells. The cells of a
/// kind (tets, prisms or pyramids) are all reversed if most have negative volume; cells whose volume is
/// negative after this are really inverted, and stay so. Missing arrays are filled in: regions are numbered
/// by ascending tag (also in place of the file's numbers if one is not from 1 to 999 999 999), faces get the
/// regions of the cells beside them (and are reversed if the outside would lie behind them), and other data
/// become 0 or none. In a mesh of second order, faces and edges without mid-edge nodes get those of the cells
/// with volume. Throws ReadError (path) if cells of first and second order are mixed. Preconditions: points
/// and cells are set, and the cells' nodes are in range; other arrays have their full length or are empty.
/// Cost: expected linear.
void complete_mesh(const std::string& path, TetMesh& mesh);

}  // namespace collarmesh::io
