#pragma once

#include <cstddef>

#include "collarmesh/bounds.h"
#include "improve/workpiece.h"

namespace collarmesh::improvement {

/// Inserts a vertex in the middle of the longest edge on a curve of each tet whose angles miss their bounds,
/// where that edge is much longer than others of the tet: no other operation divides curves. Tets may be poor
/// afterwards; improve them. Returns the number of vertices.
std::size_t divide_curves_at_poor_tets(Workpiece& workpiece, const Bounds& bounds);

}  // namespace collarmesh::improvement
