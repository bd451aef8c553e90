#pragma once

#include <string_view>
#include <vector>

#include "collarmesh/tet_mesh.h"

namespace collarmesh {

/// Returns the mesh with its prisms and pyramids cut into tets, which follow the mesh's own tets, and its
/// quadrangles cut into triangles. Quadrangles are cut along the diagonals from their corners of smallest
/// index, so that neighbours conform. In second order each diagonal gets a node in the middle of the
/// quadrangle, interpolated from its nodes. The result's `layers` has only `tet_layer`, which is above 0 for
/// all tets of prisms and pyramids. Precondition: the arrays of a kind of cell have the same length. Cost:
/// linear; in second order O(n log n) for n edges of the mesh.
TetMesh tets_of_layers(const TetMesh& mesh);

/// Throws OptionError if the mesh has prisms or pyramids. `what` begins the message.
void require_tets_alone(const TetMesh& mesh, std::string_view what);

/// Returns for each point in layers the wall's point below it, found along the rising edges of cells; none
/// for others. These edges lead from the first three corners of a prism to the others, from the first two of
/// a pyramid to the next two, from the first of a tet to the last. Cells that do not lie above one listed
/// triangle do not count. Cost: O(n log n).
std::vector<Index> walls_below(const TetMesh& mesh);

}  // namespace collarmesh
