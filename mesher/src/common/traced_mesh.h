#pragma once

#include <string>

#include "collarmesh/tet_mesh.h"
#include "collarmesh/trace.h"

namespace collarmesh {

/// Returns a mesh as a step of a trace.
TraceStep traced_mesh(const TetMesh& mesh, std::string stage);

}  // namespace collarmesh
