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

/// The name of the label `feature`; ParallelMesh describes its values.
inline constexpr const char* feature_label = "feature";
inline PetscInt encoded(const TetMesh::VertexFeature& feature) {
  // All vertices of the complex share one value: their places tell them apart.
  return feature.dimension == 0 ? 0 : static_cast<PetscInt>(4 * feature.feature + feature.dimension);
}
inline TetMesh::VertexFeature decoded(PetscInt code) {
  if (code < 0) return {3, none};
  return {static_cast<std::uint8_t>(code % 4), code == 0 ? none : static_cast<Index>(code / 4)};
}

/// Returns the values of a label at `count` points from `first` on; -1 for points without the label.
std::vector<PetscInt> label_values(DM dm, const char* name, PetscInt first, std::size_t count);

/// The mesh of a rank, as the functions of the library take it. Points are the vertices, in the order of the
/// DMPlex; in a mesh of second order, the nodes of all edges follow, likewise in order. Tets are positively
/// oriented if the DMPlex has them so. Faces are those on patches, edges those on curves; other ranks may
/// have them, too. Leaves out what the DMPlex does not have: regions, creases and marks of thin tets.
struct LocalMesh : TetMesh {
  /// Reads the mesh as one of first or second order. If the DMPlex has no coordinates of mid-edge nodes, puts
  /// these at the middles of their edges.
  LocalMesh(DM dm, int order);

  Corners corners(std::size_t tet) const {
    const auto& t = tets[tet];
    return {points[t[0]], points[t[1]], points[t[2]], points[t[3]]};
  }
  Point middle(std::size_t edge) const { return 0.5 * (points[ends[edge][0]] + points[ends[edge][1]]); }

  std::size_t vertices = 0;                ///< number of points that are vertices
  std::vector<std::array<Index, 2>> ends;  ///< vertices of all edges of the rank
  /// For each face in `faces`, its number among all faces of the rank; likewise for each edge in `edges`.
  std::vector<std::size_t> face_number, edge_number;

 private:
  void read_edges(int order);
  void read_faces(int order);
  void read_tets(int order);

  DM dm_;
};

/// Sets the coordinates of the DMPlex's vertices and, if there are more points, of its mid-edge nodes.
void set_points(DM dm, const std::vector<Point>& points);

/// Returns the corners of a face, given its number in the DMPlex.
std::array<Index, 3> corners_of_face(DM dm, PetscInt face);

}  // namespace collarmesh::distributed
