#pragma once

#include <petscdmplex.h>

#include "collarmesh/distributed.h"

namespace collarmesh::distributed {

/// Moves the vertices on features of a mesh of first order onto the shape, and makes room for them; see
/// ParallelMesh::refine. All tets have positive volume before and after. Collective.
LevelReport place(DM dm, const Shape& shape, const AngleBounds& wanted);

}  // namespace collarmesh::distributed
