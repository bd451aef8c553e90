#pragma once

#include <cstddef>

#include "collarmesh/bounds.h"
#include "improve/workpiece.h"

namespace collarmesh::improvement {

/// Divides curve edges, which no other operation does: inserts a vertex in the middle of the longest curve
/// edge of each tet whose angles miss their bounds, if that edge is much longer than other edges of the tet.
/// Tets may have poor shapes afterwards and should be improved. Returns the number of vertices.
std::size_t divide_curves_at_poor_tets(Workpiece& workpiece, const Bounds& bounds);

}  // namespace collarmesh::improvement
