#pragma once

#include "collarmesh/mesher.h"
#include "collarmesh/plc.h"
#include "collarmesh/progress.h"
#include "collarmesh/tet_mesh.h"

namespace collarmesh::remeshing {

/// Brings a mesh of a complex, with tets of any shapes, to about its sizes: collapses short edges, divides
/// long ones, and improves tets. Coarsening and improvement must follow. `options.bounds.tolerance` must be
/// set. Returns false if it was stopped, or if the vertices reached `options.max_vertices`.
bool bring_to_size(TetMesh& mesh, const Plc& plc, const MeshOptions& options, const Execution& execution);

/// Improves tets and collapses the edges that this permits, with the only bound that no tet around gets much
/// worse.
void relax(TetMesh& mesh, const Plc& plc, const MeshOptions& options, const Execution& execution);

}  // namespace collarmesh::remeshing
