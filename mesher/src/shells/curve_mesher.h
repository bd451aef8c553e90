#pragma once

#include "collarmesh/exact_geometry.h"
#include "collarmesh/mesher.h"
#include "collarmesh/project_boundary.h"
#include "collarmesh/second_order.h"
#include "collarmesh/surface_tolerance.h"
#include "collarmesh/tet_mesh.h"

namespace collarmesh::shells {

/// A mesh of curve edges alone.
struct CurveMesh {
  TetMesh mesh;
  ProjectReport projection;
  SecondOrderReport second_order;
};

/// Divides all curves of a complex by the sizes, within the tolerance. With exact geometry, the vertices lie
/// on it, and so do the mid-edge nodes of order 2; a node that would be farther than the tolerance from its
/// place on the complex, or would fold its edge, stays on the complex. Cost: linear in the points and edges.
CurveMesh mesh_curves(const Plc& plc, const MeshOptions& options, const SurfaceTolerance& tolerance,
                      unsigned order, const ExactGeometry& exact);

}  // namespace collarmesh::shells
