#pragma once

#include <array>
#include <span>
#include <vector>

#include "collarmesh/tet_mesh.h"

namespace collarmesh {

/// The place of a point in a mesh.
struct MeshPlace {
  Index tet = none;                   ///< none: the point is outside all tets
  std::array<double, 4> shares = {};  ///< barycentric coordinates of the point in that tet; their sum is 1
  Index nearest = none;               ///< nearest point of the mesh, if the point is outside all tets
};

/// Returns the place of each point, in their order. Tets of second order count as straight. Cost: near linear
/// in the mesh and the points.
std::vector<MeshPlace> locate(const TetMesh& mesh, std::span<const Point> points);

}  // namespace collarmesh
