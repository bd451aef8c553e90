#pragma once

#include "pipeline/mesh_job.h"

namespace collarmesh::pipeline {

/// Moves the vertices of a complete mesh onto the exact geometry, where there is some.
void project(MeshJob& job);

/// Makes the cells curved ones if the options ask for the second order.
void raise_order(MeshJob& job);

}  // namespace collarmesh::pipeline
