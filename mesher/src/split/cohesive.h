#pragma once

#include <vector>

#include "collarmesh/split.h"

namespace collarmesh::splitting {

/// A triangle of the minus side and the coincident one of the plus side, as faces of the mesh.
struct SidePair {
  Index minus, plus;
};

/// Fills each pair with a prism of zero thickness.
void add_prisms(const TetMesh& mesh, const std::vector<SidePair>& pairs, Interfaces& interfaces);

}  // namespace collarmesh::splitting
