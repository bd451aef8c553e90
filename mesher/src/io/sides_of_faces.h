#pragma once

#include <algorithm>
#include <vector>

#include "collarmesh/tet_mesh.h"
#include "io/cell_nodes.h"
#include "io/face_finder.h"

namespace collarmesh::io {

/// A side of the cell of a volume.
struct SideOfCell {
  CellKind kind = CellKind::tet;
  Index cell = none;
  std::size_t side = 0;  ///< place in the shape's sides
};

/// Calls `call(side, face, behind)` for each side of a volume that is a triangle or quadrangle of the mesh;
/// `behind`: the cell lies on the side from which the face's normal points away. `kind`: that of the faces.
template <class Call>
void for_each_listed_side(const TetMesh& mesh, CellKind kind, const Call& call) {
  const auto go = [&](const auto& faces, auto finder) {
    if (faces.empty()) return;
    constexpr std::size_t n = std::tuple_size_v<typename decltype(finder)::Polygon>;
    for_each_kind(mesh, 3, [&](CellKind volume) {
      const CellShape shape = shape_of(volume);
      for (Index cell = 0; cell < count_of(mesh, volume); ++cell) {
        const CellNodes nodes = nodes_of(volume)(mesh, cell);
        for (std::size_t side = 0; side < shape.sides.size(); ++side) {
          if (shape.sides[side].corners != n) continue;
          typename decltype(finder)::Polygon outward;
          for (std::size_t k = 0; k < n; ++k) outward[k] = nodes[shape.sides[side].places[k]];
          const Index face = finder.find(outward);
          if (face != none) call(SideOfCell{volume, cell, side}, face, finder.alike(faces[face], outward));
        }
      }
    });
  };
  if (kind == CellKind::triangle)
    go(mesh.faces, PolygonFinder<3>(mesh.faces));
  else
    go(mesh.layers.quads, PolygonFinder<4>(mesh.layers.quads));
}

/// Finds a side for each face of a kind, triangles or quadrangles: of the cell behind it, if there is one.
inline std::vector<SideOfCell> sides_of_faces(const TetMesh& mesh, CellKind kind = CellKind::triangle) {
  std::vector<SideOfCell> found(count_of(mesh, kind));
  for_each_listed_side(mesh, kind, [&](const SideOfCell& side, Index face, bool behind) {
    if (behind || found[face].cell == none) found[face] = side;
  });
  return found;
}

}  // namespace collarmesh::io
