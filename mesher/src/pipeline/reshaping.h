#pragma once

#include <vector>

#include "pipeline/mesh_job.h"
#include "remesh/editable_mesh.h"

namespace collarmesh::pipeline {

/// Coarsens and improves the mesh of the job and inserts interior nodes, as the options ask for. Fixed
/// vertices stay where they are.
void reshape(MeshJob& job, const std::vector<Index>& fixed = {});

/// Improves a mesh of the job's complex before it is coarsened, with the bounds of the job.
void improve_before_coarsening(MeshJob& job, TetMesh& mesh);

/// Coarsens and improves a mesh of the job's complex, with the bounds of the job. Fixed vertices stay where
/// they are. `thoroughly`: also by means that are slow if many tets stay poor.
void coarsen_and_improve(MeshJob& job, TetMesh& mesh, const std::vector<Index>& fixed,
                         bool thoroughly = true);

/// Coarsens an edited mesh by `options`, then improves it by the options of the job. If `insert` is set, then
/// inserts and removes vertices at tets that miss or nearly miss their bounds. Last, if the job asks for
/// interior nodes, replaces tets that have no corner inside a region.
void reshape(MeshJob& job, remeshing::EditableMesh& edited, const MeshOptions& options, bool insert);

}  // namespace collarmesh::pipeline
