#pragma once

#include "collarmesh/mesher.h"
#include "common/known_neighbours.h"

namespace collarmesh {

/// As the public one. `neighbours`: what the triangulation knows of the mesh's tets, for the stages to come.
MeshResult generate(const Plc& plc, const MeshOptions& options, const Execution& execution,
                    KnownNeighbours& neighbours);

}  // namespace collarmesh
