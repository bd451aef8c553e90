#pragma once

#include "pipeline/mesh_job.h"

namespace collarmesh::pipeline {

/// Returns the options of the refinement. Its bounds are tighter than the finished mesh's if vertices will
/// move onto exact geometry. Precondition: the job has its complex and options.
MeshOptions options_of_refinement(const MeshJob& job, NarrowCells narrow_cells);

/// Returns the radius-edge ratio above which tets are marked as thin. With exact geometry it lies above the
/// bound, because a tet just above the bound may be within it once its vertices have moved.
double least_thin_ratio(const MeshJob& job);

/// Makes the refined mesh. Throws Ended if the run is cancelled or a budget is hit.
void refine(MeshJob& job);

}  // namespace collarmesh::pipeline
