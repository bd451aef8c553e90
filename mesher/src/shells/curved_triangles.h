#pragma once

#include "collarmesh/exact_geometry.h"
#include "collarmesh/second_order.h"
#include "shells/surface_mesher.h"

namespace collarmesh::shells {

/// Adds mid-edge nodes to a surface mesh of first order: on curves, on smooth patches, and in the middle of
/// edges inside planar patches. Uses the exact geometry, if there is any. A node moves back towards the
/// middle of its edge if the Jacobian of one of its triangles would be `least_jacobian` or less, relative to
/// the straight triangle. Precondition: `mesh` is the result of `mesher.mesh()`.
SecondOrderReport curve_triangles(TetMesh& mesh, const Plc& plc, SurfaceMesher& mesher,
                                  const ExactGeometry& exact, double least_jacobian = 0.1);

}  // namespace collarmesh::shells
