#pragma once

#include "collarmesh/check.h"
#include "files/complex_input.h"

namespace collarmesh::files {

/// Certifies a mesh against the complex of `input`. If it misses a guarantee, also tries the complexes of
/// stronger repairs, because the mesh may have been made from one of those (`further_repairs`,
/// `coarser_repairs`). Throws like `ComplexInput::build`.
CheckReport check_against(const TetMesh& mesh, ComplexInput& input, const RunOptions& options,
                          const Execution& execution = {});

}  // namespace collarmesh::files
