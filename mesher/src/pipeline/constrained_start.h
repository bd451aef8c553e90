#pragma once

#include "pipeline/mesh_job.h"

namespace collarmesh::pipeline {

/// Thrown where constrained tetrahedra keep poor shapes and other ways are left.
struct Hopeless {};
/// How much is expected of constrained tetrahedra: anything, or a mesh that keeps every guarantee.
enum class Hope { any, good };

/// Makes the constrained tetrahedra of the complex, and brings them to the size. Throws Ended.
void tetrahedralize(MeshJob& job);

/// Relaxes, coarsens and improves what is left of them once more, as long as that makes fewer tets miss their
/// bounds. With good hope only, throws Hopeless where many tets miss these.
void settle(MeshJob& job, Hope hope);

}  // namespace collarmesh::pipeline
