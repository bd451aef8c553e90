#pragma once

#include "collarmesh/mesher.h"
#include "collarmesh/plc.h"
#include "collarmesh/progress.h"
#include "collarmesh/tet_mesh.h"

namespace collarmesh::remeshing {

/// Brings a mesh of a complex, with tets of any shapes, to about its sizes: short edges are contracted, long
/// ones divided, and tets made better. Coarsening and improvement are to follow. `options.bounds.tolerance`
/// must be set. Returns false if it was stopped, or if the vertices reached `options.max_vertices`.
bool bring_to_size(TetMesh& mesh, const Plc& plc, const MeshOptions& options, const Execution& execution);

/// Makes tets better, without a bound but that none around gets much worse, and contracts what that permits.
void relax(TetMesh& mesh, const Plc& plc, const MeshOptions& options, const Execution& execution);

}  // namespace collarmesh::remeshing
