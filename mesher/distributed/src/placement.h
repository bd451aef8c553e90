#pragma once

#include <petscdmplex.h>

#include "collarmesh/distributed.h"

namespace collarmesh::distributed {

/// Moves the vertices of a mesh of first order that lie on features onto the shape, and makes room for them;
/// see ParallelMesh::refine. Every tet is positive before and after. Collective.
LevelReport place(DM dm, const Shape& shape, const AngleBounds& wanted);

}  // namespace collarmesh::distributed
