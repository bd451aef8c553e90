#pragma once

#include <array>
#include <map>
#include <vector>

#include "collarmesh/tet_mesh.h"
#include "common/face_finder.h"
#include "io/cell_nodes.h"

namespace collarmesh::io {

/// A side of a cell with volume.
struct SideOfCell {
  CellKind kind = CellKind::tet;
  Index cell = none;
  std::size_t side = 0;  ///< place in the shape's sides
};

/// Calls `call(side, face, behind)` for each side of a cell with volume that coincides with one of `faces`,
/// triangles or quadrangles. `behind`: whether the cell is behind the face, so that the normal points away
/// from the cell.
template <std::size_t n, class Call>
void for_each_side_among(const std::vector<std::array<Index, n>>& faces, const TetMesh& mesh,
                         const Call& call) {
  if (faces.empty()) return;
  PolygonFinder<n> finder(faces);
  for_each_kind(mesh, 3, [&](CellKind kind) {
    const CellShape shape = shape_of(kind);
    for (Index cell = 0; cell < count_of(mesh, kind); ++cell) {
      const CellNodes nodes = nodes_of(kind)(mesh, cell);
      for (std::size_t side = 0; side < shape.sides.size(); ++side) {
        const auto& [corners, places] = shape.sides[side];
        if (corners != n) continue;
        std::array<Index, n> outward{};
        for (std::size_t k = 0; k < n; ++k) outward[k] = nodes[places[k]];
        const Index face = finder.find(outward);
        if (face != none)
          call(SideOfCell{kind, cell, side}, face, PolygonFinder<n>::alike(faces[face], outward));
      }
    }
  });
}

/// Calls `call` as `for_each_side_among` does, for all faces of a kind (triangles or quadrangles) of a mesh.
template <class Call>
void for_each_listed_side(const TetMesh& mesh, CellKind kind, const Call& call) {
  if (kind == CellKind::triangle)
    for_each_side_among(mesh.faces, mesh, call);
  else
    for_each_side_among(mesh.layers.quads, mesh, call);
}

/// Returns for each triangle or quadrangle the side of a cell that coincides with it, of the cell behind it
/// if there is one. Beside no cell, `cell` is `none`.
inline std::vector<SideOfCell> sides_of_faces(const TetMesh& mesh, CellKind kind = CellKind::triangle) {
  std::vector<SideOfCell> found(count_of(mesh, kind));
  for_each_listed_side(mesh, kind, [&](const SideOfCell& side, Index face, bool behind) {
    if (behind || found[face].cell == none) found[face] = side;
  });
  return found;
}

/// Returns the sides that `sides_of_faces` finds for triangles and quadrangles, by tag. Leaves out faces
/// beside no cell.
inline std::map<Tag, std::vector<SideOfCell>> sides_by_tag(const TetMesh& mesh) {
  std::map<Tag, std::vector<SideOfCell>> by_tag;
  for_each_kind(mesh, 2, [&](CellKind kind) {
    const std::vector<SideOfCell> sides = sides_of_faces(mesh, kind);
    for (std::size_t f = 0; f < sides.size(); ++f)
      if (sides[f].cell != none) by_tag[tags_of(mesh, kind)[f]].push_back(sides[f]);
  });
  return by_tag;
}

}  // namespace collarmesh::io
