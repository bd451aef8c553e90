#pragma once

#include <array>
#include <vector>

#include "collarmesh/tet_mesh.h"

namespace collarmesh::remeshing {

using Triangle = std::array<Index, 3>;

Triangle sorted(Triangle corners);

/// A triangle that parts a region from another one or from the outside, or that the mesh lists.
struct MeshSide {
  Triangle corners;     ///< the tet `behind` is at their back
  Index behind, front;  ///< tets; none: the outside
  Index face;           ///< the one that the mesh lists; none if it does not
};

/// Finds these triangles, in the order of their tets, and tells which tets are connected without passing
/// through one. Throws PlcError for sides that more than two tets share and for listed faces that are no side
/// of a tet. Cost: O(n log n).
struct MeshSides {
  explicit MeshSides(const TetMesh& mesh);

  std::vector<MeshSide> sides;
  std::vector<Index> component;  ///< by tet: of the tets connected to it, the first
};

}  // namespace collarmesh::remeshing
