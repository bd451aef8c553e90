#pragma once

#include <vector>

#include "constrained/sheathed_rods.h"
#include "pipeline/mesh_job.h"
#include "pipeline/refinement.h"

namespace collarmesh::pipeline {

/// Returns the thin rods and rings of the complex that lie inside other regions and have room for sheaths,
/// with their sheaths. Throws Ended.
std::vector<SheathedRod> find_sheathed_rods(MeshJob& job);

/// Makes a mesh of a complex with sheathed rods: refines the complex without the rods, and replaces the
/// elements around their axes by the tetrahedra of the rods and their sheaths. If the refined mesh has no
/// room for some rods, removes these from the list, and refines once more with these rods in the complex.
/// Sets `fixed` to the vertices of the rods that stay in the list; coarsening should not move them. Returns
/// whether it made such a mesh within the limit on vertices. Throws Ended, FarTooFine, and PlcError.
bool refine_around_rods(MeshJob& job, std::vector<SheathedRod>& rods, std::vector<Index>& fixed,
                        Fineness fineness);

}  // namespace collarmesh::pipeline
