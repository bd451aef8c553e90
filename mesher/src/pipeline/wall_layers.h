#pragma once

#include "pipeline/mesh_job.h"

namespace collarmesh::pipeline {

/// Puts layers on walls, if asked for, and checks the mesh with its layers.
void add_layers(MeshJob& job);

}  // namespace collarmesh::pipeline
