#pragma once

#include "pipeline/mesh_job.h"

namespace collarmesh::pipeline {

/// Moves the vertices of a complete mesh onto the exact geometry, if there is any.
void project(MeshJob& job);

/// Adds mid-edge nodes and curves the cells, if the options ask for second order.
void raise_order(MeshJob& job);

}  // namespace collarmesh::pipeline
