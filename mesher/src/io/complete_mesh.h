#pragma once

#include <string>

#include "collarmesh/tet_mesh.h"

namespace collarmesh::io {

/// Make a mesh as read from a file one that keeps the promises of TetMesh:
/// tets are turned to positive volume where most are negative (the others stay: they are inverted); arrays
/// the file had nothing for are filled in: regions are numbered by ascending tag (also where they are not
/// from 1 to 999 999 999), faces get the regions of the tets beside them (and are turned if the outside would
/// lie behind them), the rest gets 0 or none. In a mesh of second order, faces and edges without mid nodes
/// get those of the tets. Throws ReadError (path) if cells of first and second order are mixed.
/// Preconditions: points, tets, faces, edges are there and in range; other arrays have their length or are
/// empty. Cost: expected linear.
void complete_mesh(const std::string& path, TetMesh& mesh);

}  // namespace collarmesh::io
