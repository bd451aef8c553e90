#pragma once

#include <span>

#include "collarmesh/tet_mesh.h"

namespace collarmesh {

/// Point p becomes number[p] in all cells and balls; the points themselves stay where they are.
/// Precondition: the mesh is of first order.
inline void renumber_points(TetMesh& mesh, std::span<const Index> number) {
  const auto renumber = [&](auto& cells) {
    for (auto& cell : cells)
      for (Index& point : cell) point = number[point];
  };
  renumber(mesh.tets);
  renumber(mesh.faces);
  renumber(mesh.edges);
  for (TetMesh::CollarBall& ball : mesh.collar_balls) ball.point = number[ball.point];
}

}  // namespace collarmesh
