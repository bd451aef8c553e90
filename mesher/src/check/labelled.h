#pragma once

#include "collarmesh/check.h"

namespace collarmesh::checks {

/// Returns a mesh of tets whose points, faces and edges have the labels of the features of a complex that
/// they lie on, found by position. Throws PlcError, with the first finding, if the mesh does not cover the
/// complex. Cell shapes, and distances from the complex, may miss their bounds.
TetMesh labelled(const TetMesh& mesh, const Plc& plc, const CheckOptions& options,
                 const Execution& execution);

}  // namespace collarmesh::checks
