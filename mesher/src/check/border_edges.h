#pragma once

#include <array>
#include <vector>

#include "check/mesh_to_check.h"

namespace collarmesh::checks {

/// Finds the mesh edges on each bent curve of the complex: edges whose faces have the tags of the curve's
/// patches, except edges on other curves. Finds none on a curve inside one face, such as a seam. Positions
/// alone do not suffice, because other programs place nodes on the exact curve, off the complex's polyline.
/// Cost: O(n log n).
std::vector<std::vector<std::array<Index, 2>>> border_edges(const MeshToCheck& to_check);

}  // namespace collarmesh::checks
