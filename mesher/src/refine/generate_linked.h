#pragma once

#include "collarmesh/mesher.h"
#include "collarmesh/trace.h"
#include "common/known_neighbours.h"

namespace collarmesh {

/// As the public one. `neighbours`: what the triangulation knows of the mesh's tets, for the stages to come.
/// `trace`: becomes the steps of the run, of the last one if it is run twice; null if nobody asks for them.
MeshResult generate(const Plc& plc, const MeshOptions& options, const Execution& execution,
                    KnownNeighbours& neighbours, Trace* trace = nullptr);

}  // namespace collarmesh
