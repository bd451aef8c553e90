#pragma once

#include <array>
#include <span>
#include <vector>

#include "collarmesh/tet_mesh.h"

namespace collarmesh {

/// Where a point lies in a mesh.
struct MeshPlace {
  Index tet = none;                   ///< none: the point is outside all tets
  std::array<double, 4> shares = {};  ///< barycentric coordinates: shares of the tet's corners, whose sum is
                                      ///< 1
  Index nearest = none;               ///< nearest point of the mesh, if the place is outside
};

/// Finds points in a mesh, tets of second order taken as straight. Cost: near linear in the mesh and the
/// points.
std::vector<MeshPlace> locate(const TetMesh& mesh, std::span<const Point> points);

}  // namespace collarmesh
