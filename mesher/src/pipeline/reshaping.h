#pragma once

#include <vector>

#include "pipeline/mesh_job.h"
#include "remesh/editable_mesh.h"

namespace collarmesh::pipeline {

/// Coarsens and improves the mesh of the job and inserts interior nodes, as the options ask for. Fixed
/// vertices stay where they are.
void reshape(MeshJob& job, const std::vector<Index>& fixed = {});

/// Improves a mesh of the complex that is not coarsened yet, with the bounds of the job.
void improve_before_coarsening(MeshJob& job, TetMesh& mesh);

/// Coarsens and improves a mesh of the complex, with the bounds of the job. Fixed vertices stay where they
/// are. `thoroughly`: also by means that are slow if many tets stay poor.
void coarsen_and_improve(MeshJob& job, TetMesh& mesh, const std::vector<Index>& fixed,
                         bool thoroughly = true);

/// Coarsens and improves an edited mesh by these options. If asked to, inserts vertices where tets still
/// miss their bounds. Completes interior nodes.
void reshape(MeshJob& job, remeshing::EditableMesh& edited, const MeshOptions& options, bool insert);

}  // namespace collarmesh::pipeline
