#pragma once

#include "collarmesh/mesher.h"
#include "collarmesh/trace.h"
#include "common/known_neighbours.h"

namespace collarmesh {

/// Meshes a complex like the public `generate`. Sets `neighbours` to the tets' neighbours known from the
/// triangulation, for later stages. `trace` gets the steps of the refinement (if it runs twice, of its second
/// run); null if they are not needed.
MeshResult generate(const Plc& plc, const MeshOptions& options, const Execution& execution,
                    KnownNeighbours& neighbours, Trace* trace = nullptr);

}  // namespace collarmesh
