#pragma once

#include "collarmesh/check.h"

namespace collarmesh::checks {

/// Returns a copy of a mesh of tets in which points, faces and edges have the labels of the complex's
/// features that they lie on. Finds missing labels by position. Throws PlcError, with the first finding, if
/// the mesh misses a guarantee that is not in guarantee::of_shapes.
TetMesh labelled(const TetMesh& mesh, const Plc& plc, const CheckOptions& options,
                 const Execution& execution);

}  // namespace collarmesh::checks
