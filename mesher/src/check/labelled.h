#pragma once

#include "collarmesh/check.h"

namespace collarmesh::checks {

/// Returns a mesh of tets with the features of a complex at its points, faces and edges, which are found by
/// position. The mesh covers the complex; its shapes, and its distances from the complex, may break bounds.
/// Throws PlcError if it does not cover it, with the first finding.
TetMesh labelled(const TetMesh& mesh, const Plc& plc, const CheckOptions& options,
                 const Execution& execution);

}  // namespace collarmesh::checks
