#pragma once

#include <vector>

#include "constrained/sheathed_rods.h"
#include "pipeline/mesh_job.h"

namespace collarmesh::pipeline {

/// Returns the thin rods and rings of the complex that lie inside other regions, with sheaths around them.
/// Throws Ended.
std::vector<SheathedRod> find_sheathed_rods(MeshJob& job);

/// Makes a mesh of a complex with such rods: refines the complex without them, and puts their tetrahedra and
/// those of their sheaths in the place of the elements there. Sets the vertices of the rods themselves, which
/// should stay when the mesh is coarsened. Returns whether there is room for them. Throws Ended.
bool refine_around_rods(MeshJob& job, const std::vector<SheathedRod>& rods, std::vector<Index>& fixed);

}  // namespace collarmesh::pipeline
