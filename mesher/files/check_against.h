#pragma once

#include "collarmesh/check.h"
#include "files/complex_input.h"

namespace collarmesh::files {

/// Certifies a mesh against the complex of `input`; if it was made of an input that had to be repaired
/// further (`further_repairs`), against that complex. Throws as `ComplexInput::build`.
CheckReport check_against(const TetMesh& mesh, ComplexInput& input, const RunOptions& options,
                          const Execution& execution = {});

}  // namespace collarmesh::files
