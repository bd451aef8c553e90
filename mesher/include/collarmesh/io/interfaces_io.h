#pragma once

#include <string>
#include <string_view>

#include "collarmesh/io/tet_mesh_io.h"
#include "collarmesh/split.h"

namespace collarmesh::io {

/// Writes a mesh with split patches, with the elements and conditions between their sides. Format .inp: a
/// `*TIE` for each pair of sides, or a `*CONTACT PAIR` with the interaction that the job defines by the name
/// CONTACT; cohesive elements (COH3D6) are in the element set COHESIVE and in one set for each patch. Throws
/// WriteError, also if the format has no place for interfaces.
void write_tet_mesh(const std::string& path, const TetMesh& mesh, const Interfaces& interfaces,
                    std::string_view format = {}, GhostCells ghost_cells = GhostCells::off);

/// Throws WriteError if the format cannot express the conditions or elements between sides that the options
/// ask for.
void require_place_for_interfaces(const std::string& path, const SplitOptions& options,
                                  std::string_view format = {});

}  // namespace collarmesh::io
