#pragma once

#include <vector>

#include "collarmesh/geometry.h"
#include "collarmesh/tet_mesh.h"

namespace collarmesh::cli {

/// Multiplies coordinates by a factor, to change the unit of length of the output.
inline void scale(std::vector<Point>& points, double factor) {
  if (factor == 1) return;
  for (Point& p : points) p = {factor * p.x, factor * p.y, factor * p.z};
}

/// Scales the mesh and the motions of its periodic faces.
inline void scale(TetMesh& mesh, double factor) {
  scale(mesh.points, factor);
  for (TetMesh::PeriodicFaces& faces : mesh.periodic)
    if (factor != 1) faces.motion.shift = factor * faces.motion.shift;
}

}  // namespace collarmesh::cli
