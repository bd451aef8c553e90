#pragma once

#include "check/subject.h"

namespace collarmesh::checks {

/// Checks that faces of solids point outwards, and that those of other patches agree with their neighbours
/// where two patches meet, as far as the surface is orientable. `plc` has the regions. Precondition:
/// subject.match is filled in.
void check_shell_orientation(const Subject& subject, const Plc& plc, Findings& findings);

}  // namespace collarmesh::checks
