#pragma once

#include <array>
#include <vector>

#include "check/mesh_to_check.h"

namespace collarmesh::checks {

/// Returns the mesh edges on each curve of the complex; none for straight curves. An edge belongs to the
/// nearest bent curve whose patches have the tags of the edge's faces. An edge of exactly two faces, both
/// with the same tag, belongs to no curve, so a curve inside one face of the input, such as a seam, has no
/// edges here. Positions alone do not suffice, because other programs place nodes on the exact curve, off the
/// complex's polyline. Cost: O(n log n).
std::vector<std::vector<std::array<Index, 2>>> border_edges(const MeshToCheck& to_check);

}  // namespace collarmesh::checks
