#pragma once

#include "pipeline/mesh_job.h"

namespace collarmesh::pipeline {

/// Gives the refined mesh the nodes of another one, the source, on both sides of each pair, coarsens it
/// with these, and makes the triangles alike. Then the tets beside them are coarsened and improved
/// together, while the mesh is cut open elsewhere. If some stay poor, curves are divided there, and all is
/// done again with these nodes. The source is the coarsened mesh, but first, if there are smooth patches,
/// the refined one: wedges that these make with the sides need their nodes on both sides.
void make_faces_periodic(MeshJob& job);

}  // namespace collarmesh::pipeline
