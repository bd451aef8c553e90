#pragma once

#include <vector>

#include "collarmesh/mesher.h"
#include "collarmesh/plc.h"
#include "collarmesh/tet_mesh.h"

namespace collarmesh::remeshing::coarsening {

/// Returns the target edge length at every vertex of a refined mesh, absolute: the length of its feature or
/// region, reduced by curvature, gaps and the size field, as in the refinement. Away from small sizes it
/// grows by the gradation per unit length; without a gradation, by as much as a bounded radius-edge ratio
/// allows. Cost: near linear.
std::vector<double> target_sizes(const TetMesh& mesh, const Plc& plc, const MeshOptions& options);

/// Reduces sizes at the vertices of a mesh where they grow along an edge by more than this share of its
/// length. Cost: n log n.
void grade_sizes(const TetMesh& mesh, double growth, std::vector<double>& sizes);

}  // namespace collarmesh::remeshing::coarsening
