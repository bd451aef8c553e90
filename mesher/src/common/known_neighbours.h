#pragma once

#include <array>

#include "collarmesh/geometry.h"
#include "common/large_pages.h"

namespace collarmesh {

/// For each tet of a mesh, the tets across the faces opposite its corners, as far as they are known; `none`
/// at a boundary or if unknown.
using KnownNeighbours = LargeVector<std::array<Index, 4>>;

}  // namespace collarmesh
