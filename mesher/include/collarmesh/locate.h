#pragma once

#include <array>
#include <span>
#include <vector>

#include "collarmesh/tet_mesh.h"

namespace collarmesh {

/// Where a point lies in a mesh.
struct MeshPlace {
  Index tet = none;                   ///< none: it is outside of all
  std::array<double, 4> shares = {};  ///< of the tet's corners; their sum is 1, and they give the point
  Index nearest = none;               ///< of the mesh's points, where it is outside
};

/// Find points in a mesh, tets of second order taken as straight. Cost: near linear in the mesh and the
/// points.
std::vector<MeshPlace> locate(const TetMesh& mesh, std::span<const Point> points);

}  // namespace collarmesh
