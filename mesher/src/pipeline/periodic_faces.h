#pragma once

#include "pipeline/mesh_job.h"

namespace collarmesh::pipeline {

/// Returns whether faces are to be made periodic before anything is coarsened: smooth patches may meet the
/// pairs' patches at any angle, and such wedges need their nodes on both sides.
bool begins_with_refined(const MeshJob& job);

/// Gives the refined mesh the nodes of another one, the source, on both sides of each pair, coarsens it
/// with these, and makes the triangles alike. Then the tets beside them are coarsened and improved
/// together, while the mesh is cut open elsewhere. If some stay poor, curves are divided there, and all is
/// done again with these nodes. The source is the coarsened mesh, but first the refined one if
/// `begins_with_refined`.
void make_faces_periodic(MeshJob& job);

}  // namespace collarmesh::pipeline
