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

/// Divides all curves of a complex by the sizes, within the tolerance. With exact geometry, vertices inside
/// curves move onto it by at most the largest tolerance, and mid-edge nodes (order 2) by less than half an
/// edge; the others stay on the complex. A mid-edge node that would fold its edge is put into the middle of
/// the straight edge. Cost: linear in the points and edges.
CurveMesh mesh_curves(const Plc& plc, const MeshOptions& options, const SurfaceTolerance& tolerance,
                      unsigned order, const ExactGeometry& exact);

}  // namespace collarmesh::shells
