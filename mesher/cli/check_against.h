#pragma once

#include "collarmesh/check.h"
#include "complex_input.h"

namespace collarmesh::cli {

/// The certificate of a mesh against the complex of `input`, built as `how` says; for meshes of inputs that
/// had to be repaired further (`further_repairs`), against the complex of that. Throws as
/// `ComplexInput::build`.
CheckReport check_against(const TetMesh& mesh, ComplexInput& input, ComplexArguments how,
                          const CheckOptions& options, const Execution& execution = {});

}  // namespace collarmesh::cli
