#pragma once

#include "collarmesh/plc.h"
#include "collarmesh/progress.h"
#include "collarmesh/tet_mesh.h"

namespace collarmesh {

/// A mesh that has the facets and segments of a complex as faces and edges, undivided where possible.
struct ConstrainedTetrahedra {
  TetMesh mesh;                  ///< empty if the run was cancelled
  std::size_t added_points = 0;  ///< points added because features could not be recovered otherwise
};

/// Makes the Delaunay tetrahedra of a complex's points, and changes them where facets or segments are
/// missing. Shapes and sizes of the tetrahedra follow from the complex; their number is about that of its
/// triangles, however near features are to each other. Throws PlcError if features intersect, or are so near
/// each other that rounded points cannot separate them.
ConstrainedTetrahedra constrained_tetrahedra(const Plc& plc, const Execution& execution = {});

}  // namespace collarmesh
