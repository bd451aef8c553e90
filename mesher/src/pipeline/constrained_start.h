#pragma once

#include "pipeline/mesh_job.h"

namespace collarmesh::pipeline {

/// Thrown if constrained tetrahedra keep poor shapes and there are other ways to make a mesh.
struct Hopeless {};
/// The mesh wanted from constrained tetrahedra: any, or only one that probably keeps every guarantee.
enum class Hope { any, good };

/// Returns whether the options permit a start from constrained tetrahedra where refinement takes too many
/// vertices.
bool may_start_constrained(const PipelineOptions& options);

/// Returns whether hardly any tet has an edge far longer than this size.
bool keeps_lengths(const TetMesh& mesh, double size);

/// Returns whether the options permit a mesh of rings around rods. The edges of such a mesh have one size, so
/// the options must not ask for other sizes, for a surface distance or for better shapes than usual.
bool may_have_rods(const MeshJob& job);

/// Makes a mesh of rings around rods, if all bodies of the complex are thin rods. Returns false if not, or if
/// a tet misses the bounds on its shape. Throws Ended.
bool fill_rods(MeshJob& job);

/// Makes the constrained tetrahedra of the complex, and brings their edges to the target lengths. Throws
/// Ended. With Hope::good, throws Hopeless if so many tets miss their bounds that improvement cannot help.
void tetrahedralize(MeshJob& job, Hope hope);

/// Relaxes, coarsens and improves the mesh again, as long as that reduces the number of tets that miss their
/// bounds. With Hope::good, throws Hopeless if many tets miss their bounds at first. If the time for a
/// further attempt runs out, keeps the best mesh so far.
void settle(MeshJob& job, Hope hope);

/// Removes flat tets that miss their bounds from a refined and coarsened mesh, by dividing edges so that
/// vertices on the two sides of a tet lie opposite each other. Uses the result if fewer tets miss their
/// bounds then.
void mend_flat_tets(MeshJob& job);

}  // namespace collarmesh::pipeline
