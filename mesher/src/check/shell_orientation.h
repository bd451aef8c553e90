#pragma once

#include "check/mesh_to_check.h"

namespace collarmesh::checks {

/// Checks that faces of solids point outwards, and that those of other patches agree with their neighbours
/// where two patches meet, as far as the surface is orientable. `plc` has the regions. Precondition:
/// to_check.match is filled in.
void check_shell_orientation(const MeshToCheck& to_check, const Plc& plc, Findings& findings);

}  // namespace collarmesh::checks
