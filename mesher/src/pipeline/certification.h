#pragma once

#include <cstddef>

#include "pipeline/mesh_job.h"

namespace collarmesh::pipeline {

/// Returns whether a finding says that a tet misses the bounds on its shape.
bool is_about_shape(const Finding& finding);

/// Returns whether the only missed guarantees, at least one, are those on volumes and thicknesses, which may
/// hold with a smaller surface distance.
bool misses_volumes_only(const CheckReport& check);

/// Returns whether a refined mesh has so many findings that further seeds or smaller tolerances would hardly
/// help, and a mesh from constrained tetrahedra has less than a tenth as many findings per tet.
bool misses_far_less(const PipelineResult& constrained, const PipelineResult& refined);

/// Returns the number of findings on shapes of tets, plus 1000 times the number of findings on nodes, edges
/// and faces that lack an image on the other side of a periodic pair.
std::size_t count_misshapen(const MeshJob& job, const TetMesh& mesh);

/// Checks the mesh against the bounds that the options ask for and against this tolerance of its complex.
void certify(MeshJob& job, const SurfaceTolerance& tolerance);

}  // namespace collarmesh::pipeline
