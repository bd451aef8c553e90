#pragma once

#include "pipeline/mesh_job.h"

namespace collarmesh::pipeline {

/// Divides the tets of the mesh that is kept among ranks, if the options ask for it.
void divide(MeshJob& job);

/// Gives the patches to be split nodes of their own on each side, after the mesh was certified as it is
/// before, and checks that.
void split_patches(MeshJob& job);

}  // namespace collarmesh::pipeline
