#pragma once

#include <string>
#include <string_view>

#include "collarmesh/io/tet_mesh_io.h"
#include "collarmesh/split.h"

namespace collarmesh::io {

/// Writes a mesh whose patches were split, with the elements and conditions between their sides. In .inp: a
/// `*TIE` for each pair of sides; or a `*CONTACT PAIR`, to the interaction that the job defines by the name
/// CONTACT; and cohesive elements (COH3D6), in the element set COHESIVE and one for each patch.
/// Throws WriteError, also where the format has no place for them.
void write_tet_mesh(const std::string& path, const TetMesh& mesh, const Interfaces& interfaces,
                    std::string_view format = {}, GhostCells ghost_cells = GhostCells::none);

/// Throws WriteError if the format has no place for what the options ask for between sides.
void require_place_for_interfaces(const std::string& path, const SplitOptions& options,
                                  std::string_view format = {});

}  // namespace collarmesh::io
