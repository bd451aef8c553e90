#pragma once

#include <vector>

#include "collarmesh/mesher.h"
#include "collarmesh/plc.h"
#include "collarmesh/tet_mesh.h"

namespace collarmesh::remeshing::coarsening {

/// Returns the target edge length at every vertex of a refined mesh, in input units: the size set for its
/// feature or region, reduced by curvature, gaps and the size field, as in the refinement. Away from small
/// sizes it grows by at most the gradation per unit of distance; if the gradation is 0, by a fixed growth.
/// Cost: near linear.
std::vector<double> target_sizes(const TetMesh& mesh, const Plc& plc, const MeshOptions& options);

/// Reduces sizes at the vertices of a mesh, so that along each edge they differ by at most `growth` times the
/// edge's length. Cost: n log n.
void grade_sizes(const TetMesh& mesh, double growth, std::vector<double>& sizes);

}  // namespace collarmesh::remeshing::coarsening
