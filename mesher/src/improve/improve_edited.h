#pragma once

#include <cstddef>

#include "collarmesh/improve.h"
#include "collarmesh/interior_nodes.h"
#include "remesh/editable_mesh.h"

namespace collarmesh {

/// Improves a mesh that the caller edits, like `improve`, but does not write it back or mark thin tets, and
/// runs in the caller's arena. `thoroughly`: take detours, and fill the space around flat tets with new
/// tets, which is slow where many tets stay poor.
ImproveReport improve(remeshing::EditableMesh& edited, const ImproveOptions& options,
                      const Execution& execution, bool thoroughly = true);

namespace remeshing::improvement {

/// Divides curve edges, which no other operation does: inserts a vertex in the middle of the longest curve
/// edge of each tet that misses the bounds on both its angles and its radius-edge ratio, if that edge is much
/// longer than the tet's shortest edge.
/// Tets may have poor shapes afterwards and should be improved. Returns the number of inserted vertices.
std::size_t divide_curves_at_poor_tets(EditableMesh& edited, const Bounds& bounds);

/// Gives each tet a corner inside a region, in a mesh that will be coarsened and improved: removes an edge,
/// or inserts a vertex on an edge or into a cavity, whichever leaves the best tets, even if these are poor.
/// Cells of collars become ordinary tets. Precondition: the mesh has `features`.
void insert_interior_nodes(EditableMesh& edited, const Bounds& bounds, InteriorNodesReport& report);

/// Replaces each tet of a finished mesh that lacks a corner inside a region by tets that have one and are
/// within the bounds. The tet stays if this fails (see `replace_tets`).
void complete_interior_nodes(EditableMesh& edited, const Bounds& bounds, InteriorNodesReport& report);

}  // namespace remeshing::improvement
}  // namespace collarmesh
