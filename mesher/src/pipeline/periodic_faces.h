#pragma once

#include "pipeline/mesh_job.h"

namespace collarmesh::pipeline {

/// Returns whether faces are made periodic before coarsening. This is so if the complex has smooth patches:
/// they may meet the pairs' patches at any angle, and in the wedges between them both sides of a pair need
/// the nodes that refinement made there.
bool begins_with_refined(const MeshJob& job);

/// Makes faces periodic. Takes the nodes that a source mesh has on the patches of pairs, gives the refined
/// mesh these nodes on both sides of each pair, coarsens it, and makes the triangles of both sides
/// correspond. Then joins the sides of each pair, cuts the mesh open elsewhere, and coarsens and improves the
/// tets on both sides together. If some tets stay poor, divides curves at these tets and repeats all this
/// with the new nodes. The source is the coarsened mesh; if `begins_with_refined`, the first source is the
/// refined mesh.
void make_faces_periodic(MeshJob& job);

}  // namespace collarmesh::pipeline
