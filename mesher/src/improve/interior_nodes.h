#pragma once

#include "collarmesh/bounds.h"
#include "collarmesh/interior_nodes.h"
#include "improve/workpiece.h"

namespace collarmesh::improvement {

/// Gives each tet a corner inside a region, in a mesh that will be coarsened and improved: removes an edge,
/// or inserts a vertex on an edge or into a cavity, whichever leaves the best tets, even if these are poor.
/// Cells of collars become ordinary tets. Precondition: the mesh has `features`.
void insert_interior_nodes(Workpiece& workpiece, const Bounds& bounds, InteriorNodesReport& report);

/// Gives each tet of a finished mesh a corner inside a region, so that all tets are within the bounds
/// afterwards. A tet stays if that cannot be reached (see `replace_tets`).
void complete_interior_nodes(Workpiece& workpiece, const Bounds& bounds, InteriorNodesReport& report);

}  // namespace collarmesh::improvement
