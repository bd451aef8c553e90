#pragma once

#include "collarmesh/plc.h"
#include "collarmesh/progress.h"
#include "collarmesh/tet_mesh.h"

namespace collarmesh {

/// A mesh whose faces and edges on features are those of a complex, as they are.
struct ConstrainedTetrahedra {
  TetMesh mesh;                  ///< empty if the run was cancelled
  std::size_t added_points = 0;  ///< where features could not be had otherwise
};

/// Makes tetrahedra with the facets and segments of a complex from its points: the Delaunay ones, changed
/// where facets or segments are not among their faces and edges. Their shapes and sizes are whatever the
/// complex dictates. Their number is about that of the complex's triangles however near features are to each
/// other. Throws PlcError where features intersect, or are too near each other for rounded points.
ConstrainedTetrahedra constrained_tetrahedra(const Plc& plc, const Execution& execution = {});

}  // namespace collarmesh
