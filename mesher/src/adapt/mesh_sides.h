#pragma once

#include <array>
#include <vector>

#include "collarmesh/tet_mesh.h"

namespace collarmesh::remeshing::adapting {

using Triangle = std::array<Index, 3>;

/// A triangle that separates a region from another one or from the outside, or that the mesh lists as a face.
struct MeshSide {
  Triangle corners;     ///< corners; the tet `behind` is on the triangle's back side
  Index behind, front;  ///< tets; none: the outside
  Index face;           ///< index of the mesh's face; none if it is not listed
};

/// Finds these triangles (if the mesh lists every side of its tets, faces inside a region count if they have
/// a tag other than 0), in the order of their tets, and which tets are connected without crossing such a
/// triangle. Throws PlcError for sides that more than two tets share, and for listed faces that are no side
/// of a tet; messages name points by `given`. Cost: O(n log n).
struct MeshSides {
  MeshSides(const TetMesh& mesh, const std::vector<Index>& given);

  std::vector<MeshSide> sides;
  std::vector<Index> component;  ///< by tet: the first tet connected to it
};

}  // namespace collarmesh::remeshing::adapting
