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

/// Returns the ten tets with the smallest dihedral angles, smallest first, then the tets with the ten largest
/// angles, without repeating any. `measures` must be of this mesh.
std::vector<WorstTet> worst_tets(const TetMesh& mesh, const MeshMeasures& measures);

}  // namespace collarmesh::report
