#pragma once

#include <array>

#include "collarmesh/geometry.h"
#include "common/large_pages.h"

namespace collarmesh {

/// By tet of a mesh the tets across the faces opposite its corners, as far as they are known: none at a
/// boundary and where it is not known.
using KnownNeighbours = LargeVector<std::array<Index, 4>>;

}  // namespace collarmesh
