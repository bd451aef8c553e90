#pragma once

#include <array>
#include <vector>

#include "collarmesh/tet_mesh.h"

namespace collarmesh::cli {

struct WorstTet {
  Index tet;
  double smallest, largest;  ///< dihedral angles, degrees
  std::array<Point, 4> corners;
};

/// Ten with the smallest dihedral angles, the smallest first, then those of the ten with the largest ones
/// that are not among them. Cost: linear.
std::vector<WorstTet> worst_tets(const TetMesh& mesh);

}  // namespace collarmesh::cli
