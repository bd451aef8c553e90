#pragma once

#include "pipeline/mesh_job.h"

namespace collarmesh::pipeline {

/// Returns the options of the refinement, with tighter bounds than the mesh keeps where its vertices move
/// onto exact geometry afterwards. Precondition: the job has its complex and options.
MeshOptions options_of_refinement(const MeshJob& job, NarrowCells narrow_cells);

/// Returns the radius-edge ratio of thin tets: just above the bound a tet may be within it once its vertices
/// have moved onto the exact geometry.
double least_thin_ratio(const MeshJob& job);

/// Makes the refined mesh. Throws Ended if it is cancelled or a budget is hit.
void refine(MeshJob& job);

}  // namespace collarmesh::pipeline
