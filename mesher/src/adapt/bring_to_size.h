#pragma once

#include "collarmesh/mesher.h"
#include "collarmesh/plc.h"
#include "collarmesh/progress.h"
#include "collarmesh/tet_mesh.h"

namespace collarmesh::remeshing::adapting {

/// `bring_to_size` makes different meshes with this number of consecutive seeds; then the meshes repeat.
inline constexpr unsigned different_seeds = 4;

/// Brings a mesh of a complex, with tets of any shapes, approximately to the target sizes: collapses short
/// edges, divides long edges, and improves tets. Coarsening and improvement must follow.
/// `options.bounds.tolerance` must be set. Returns false if it was stopped, or if the mesh reached
/// `options.max_vertices` vertices.
bool bring_to_size(TetMesh& mesh, const Plc& plc, const MeshOptions& options, const Execution& execution);

/// Improves tets, collapses short edges if no tet around gets much worse, and improves tets again. Then
/// divides edges like `face_each_other` and improves tets, in several rounds.
void relax(TetMesh& mesh, const Plc& plc, const MeshOptions& options, const Execution& execution);

/// Divides edges on opposite sides of thin places so that the new vertices face each other, if fewer tets
/// miss the bounds then or the worst are better. Returns whether the mesh has changed.
bool face_each_other(TetMesh& mesh, const Plc& plc, const MeshOptions& options, const Execution& execution);

}  // namespace collarmesh::remeshing::adapting
