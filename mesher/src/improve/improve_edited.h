#pragma once

#include <cstddef>

#include "collarmesh/improve.h"
#include "collarmesh/interior_nodes.h"
#include "remesh/editable_mesh.h"

namespace collarmesh {

/// Improves like the public `improve`, for callers that edit the mesh further: does not write the tets back
/// or mark thin tets, and runs in the caller's thread arena. `thoroughly`: also take detours, and fill the
/// space around flat tets anew, which is slow if many tets stay poor.
ImproveReport improve(remeshing::EditableMesh& edited, const ImproveOptions& options,
                      const Execution& execution, bool thoroughly = true);

namespace remeshing::improvement {

/// Divides curve edges, which improvement does not do: for each tet that violates both the bounds on thin
/// tets and the radius-edge bound, inserts a vertex in the middle of its longest edge on a curve, if this
/// edge is much longer than the tet's shortest edge. Tets may have poor shapes afterwards and should be
/// improved. Returns the number of inserted vertices.
std::size_t divide_curves_at_poor_tets(EditableMesh& edited, const Bounds& bounds);

/// Gives each tet a corner inside a region where possible, in a mesh that will be coarsened and improved:
/// removes an edge, or inserts a vertex on an edge or into a cavity, even if the new tets are poor. Cells of
/// collars become ordinary tets. Precondition: the mesh has `features`.
void insert_interior_nodes(EditableMesh& edited, const Bounds& bounds, InteriorNodesReport& report);

/// Replaces each tet without a corner inside a region by tets that have one and keep the bounds, in a
/// finished mesh. The tet stays if this fails (see `replace_tets`).
void complete_interior_nodes(EditableMesh& edited, const Bounds& bounds, InteriorNodesReport& report);

}  // namespace remeshing::improvement
}  // namespace collarmesh
