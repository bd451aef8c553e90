#pragma once

#include <cstddef>

#include "pipeline/mesh_job.h"

namespace collarmesh::pipeline {

/// Returns the options of the refinement. Its bounds are tighter than the finished mesh's if vertices will
/// move onto exact geometry. Precondition: the job has its complex and options.
MeshOptions options_of_refinement(const MeshJob& job, NarrowCells narrow_cells);

/// Returns the radius-edge ratio above which tets are marked as thin. With exact geometry it lies above the
/// bound, because a tet just above the bound may be within it once its vertices have moved.
double least_thin_ratio(const MeshJob& job);

/// Returns the feature size as an absolute length, with a margin for rounding. Walls, gaps and wedges that
/// are thinner need not be resolved.
double thinner_than_asked(const PipelineOptions& given, double diagonal);

/// Thrown if a refinement inserts many times the vertices that its sizes ask for, because of features thinner
/// than the feature size.
struct FarTooFine {
  std::size_t most;  ///< the number of vertices that was exceeded
};
/// The number of vertices that a refinement may insert: as many as the budgets permit, or not many times more
/// than the sizes ask for.
enum class Fineness { any, as_asked };

/// Makes the refined mesh. Throws Ended if the run is cancelled or a budget is hit; with Fineness::as_asked,
/// throws FarTooFine, during the refinement or at its end.
void refine(MeshJob& job, Fineness fineness = Fineness::any);

}  // namespace collarmesh::pipeline
