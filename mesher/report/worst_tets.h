#pragma once

#include <array>
#include <vector>

#include "collarmesh/mesh_measures.h"

namespace collarmesh::report {

struct WorstTet {
  Index tet;
  double smallest, largest;  ///< dihedral angles, degrees
  std::array<Point, 4> corners;
};

/// Returns ten tets with the smallest dihedral angles, smallest first, then those of the ten with the largest
/// ones that are not among them. `measures` must be of this mesh.
std::vector<WorstTet> worst_tets(const TetMesh& mesh, const MeshMeasures& measures);

}  // namespace collarmesh::report
