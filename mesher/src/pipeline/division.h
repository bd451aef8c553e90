#pragma once

#include "pipeline/mesh_job.h"

namespace collarmesh::pipeline {

/// Divides the tets of the kept mesh among ranks, if the options ask for it.
void divide(MeshJob& job);

/// Gives both sides of the patches to be split separate nodes, and checks that. The mesh was certified before
/// the split.
void split_patches(MeshJob& job);

}  // namespace collarmesh::pipeline
