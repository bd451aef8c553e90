#pragma once

#include <functional>

#include "collarmesh/periodic.h"
#include "collarmesh/surface_tolerance.h"
#include "periodic/recut.h"
#include "remesh/editable_mesh.h"

namespace collarmesh::periodicity {

/// Joins a periodic mesh at its pairs, cuts it open elsewhere (see Recut), calls `change` for the result, and
/// undoes the joins and cuts. So the triangles of pairs change in the same way on both sides. Updates the map
/// of corners. Preconditions: the mesh is of first order, and `mesh.periodic` has the pairs of its vertices.
void change_across(TetMesh& mesh, const Plc& plc, const PeriodicOptions& options, double distance,
                   const SurfaceTolerance& tolerance, Recut::Moved moved, double edges_per_hole,
                   const std::function<void(remeshing::EditableMesh&, const Recut&)>& change);

}  // namespace collarmesh::periodicity
