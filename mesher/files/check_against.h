#pragma once

#include "collarmesh/check.h"
#include "files/complex_input.h"

namespace collarmesh::files {

/// Certifies a mesh against the complex of `input`. If the mesh was made after a further repair
/// (`further_repairs`), certifies it against that complex. Throws like `ComplexInput::build`.
CheckReport check_against(const TetMesh& mesh, ComplexInput& input, const RunOptions& options,
                          const Execution& execution = {});

}  // namespace collarmesh::files
