#pragma once

#include <petscdmplex.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "collarmesh/geometry.h"
#include "collarmesh/tet_mesh.h"

namespace collarmesh::distributed {

using Corners = std::array<Point, 4>;

/// The label `feature`: see ParallelMesh.
inline constexpr const char* feature_label = "feature";
inline PetscInt encoded(const TetMesh::VertexFeature& feature) {
  // All vertices of the complex share one value: their places tell them apart.
  return feature.dimension == 0 ? 0 : static_cast<PetscInt>(4 * feature.feature + feature.dimension);
}
inline TetMesh::VertexFeature decoded(PetscInt code) {
  if (code < 0) return {3, none};
  return {static_cast<std::uint8_t>(code % 4), code == 0 ? none : static_cast<Index>(code / 4)};
}

/// Returns the values of a label at the points from `first` on; -1 where there is none.
std::vector<PetscInt> label_values(DM dm, const char* name, PetscInt first, std::size_t count);

/// The tets of a rank and their vertices, numbered from 0 as in the DMPlex.
struct LocalMesh {
  /// Reads corners and coordinates of a mesh of first order.
  explicit LocalMesh(DM dm);

  Corners corners(std::size_t tet) const {
    const auto& t = tets[tet];
    return {points[t[0]], points[t[1]], points[t[2]], points[t[3]]};
  }

  std::vector<Point> points;
  /// Positively oriented tets, as in TetMesh, if the DMPlex has them so.
  std::vector<std::array<Index, 4>> tets;
};

/// Sets the coordinates of the DMPlex's vertices.
void set_points(DM dm, const std::vector<Point>& points);

/// Returns the corners of a tet in the order of PETSc, whose tets are mirror images of ours. Vertices are
/// numbered from `first_vertex`.
std::array<Index, 4> corners_of(DM dm, PetscInt tet, PetscInt first_vertex);
/// Return the corners of a face and of an edge.
std::array<Index, 3> corners_of_face(DM dm, PetscInt face, PetscInt first_vertex);
std::array<Index, 2> ends_of_edge(DM dm, PetscInt edge, PetscInt first_vertex);

}  // namespace collarmesh::distributed
