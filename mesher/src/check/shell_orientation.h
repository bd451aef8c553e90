#pragma once

#include "check/mesh_to_check.h"

namespace collarmesh::checks {

/// Checks that faces of solids point outwards, and that those of other patches agree with their neighbours
/// where two patches meet, if the surface is orientable. `plc`: the complex with its regions; to_check.plc
/// may lack them. Precondition: to_check.match is filled in.
void check_shell_orientation(const MeshToCheck& to_check, const Plc& plc, Findings& findings);

}  // namespace collarmesh::checks
