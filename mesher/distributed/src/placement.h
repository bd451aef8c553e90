#pragma once

#include <petscdmplex.h>

#include <array>

#include "collarmesh/distributed.h"

namespace collarmesh::distributed {

/// The shares of their displacement that vertices and mid-edge nodes keep when they move back, step by step.
inline constexpr std::array<double, 4> shares{1, 0.5, 0.25, 0};

/// Moves the vertices on features of a mesh of first order onto the shape, and makes room for them; see
/// ParallelMesh::refine. All tets have positive volume before and after. Collective.
LevelReport place(DM dm, const Shape& shape, const AngleBounds& wanted);

}  // namespace collarmesh::distributed
