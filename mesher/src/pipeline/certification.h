#pragma once

#include <cstddef>

#include "pipeline/mesh_job.h"

namespace collarmesh::pipeline {

/// Returns whether a finding says that a tet misses the bounds on its shape.
bool is_about_shape(const Finding& finding);

/// Returns whether guarantees are missed, but only those on volumes and thicknesses, which may hold with a
/// smaller surface distance.
bool misses_volumes_only(const CheckReport& check);

/// Returns whether a mesh from constrained tetrahedra misses guarantees at less than a tenth as large a share
/// of its tets as a refined mesh that misses guarantees at many tets, which further seeds or smaller
/// tolerances would hardly mend.
bool misses_far_less(const PipelineResult& constrained, const PipelineResult& refined);

/// Returns the number of findings on shapes of tets, plus 1000 times the number of findings on nodes, edges
/// and faces of periodic pairs that have no image.
std::size_t count_misshapen(const MeshJob& job, const TetMesh& mesh);

/// Checks the mesh against the bounds that the options ask for and against this tolerance of its complex.
void certify(MeshJob& job, const SurfaceTolerance& tolerance);

}  // namespace collarmesh::pipeline
