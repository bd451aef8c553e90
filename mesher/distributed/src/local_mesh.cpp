#include "local_mesh.h"

#include <algorithm>

#include "calls.h"

namespace collarmesh::distributed {

namespace {

template <std::size_t n>
std::array<Index, n> closure_vertices(DM dm, PetscInt point, PetscInt first_vertex) {
  PetscInt count = 0;
  PetscInt* closure = nullptr;
  call(DMPlexGetTransitiveClosure(dm, point, PETSC_TRUE, &count, &closure));
  std::array<Index, n> vertices;
  for (std::size_t k = 0; k < n; ++k)  // the vertices are the last points
    vertices[k] = static_cast<Index>(closure[2 * (static_cast<std::size_t>(count) - n + k)] - first_vertex);
  call(DMPlexRestoreTransitiveClosure(dm, point, PETSC_TRUE, &count, &closure));
  return vertices;
}

/// The coordinates of vertices, and the position of each vertex's coordinates.
class VertexCoordinates {
 public:
  explicit VertexCoordinates(DM dm) {
    call(DMGetCoordinatesLocal(dm, &values_));
    call(DMGetCoordinateSection(dm, &section_));
  }
  std::size_t at(PetscInt vertex) const {
    PetscInt offset = 0;
    call(PetscSectionGetOffset(section_, vertex, &offset));
    return static_cast<std::size_t>(offset);
  }
  Vec values() const { return values_; }

 private:
  Vec values_ = nullptr;
  PetscSection section_ = nullptr;
};

}  // namespace

std::vector<PetscInt> label_values(DM dm, const char* name, PetscInt first, std::size_t count) {
  std::vector<PetscInt> values(count, -1);
  DMLabel label = nullptr;
  call(DMGetLabel(dm, name, &label));
  if (label == nullptr) return values;
  IS strata = nullptr;
  call(DMLabelGetValueIS(label, &strata));
  PetscInt strata_count = 0;
  const PetscInt* stratum_values = nullptr;
  call(ISGetLocalSize(strata, &strata_count));
  call(ISGetIndices(strata, &stratum_values));
  for (PetscInt s = 0; s < strata_count; ++s) {
    IS stratum = nullptr;
    call(DMLabelGetStratumIS(label, stratum_values[s], &stratum));
    if (stratum == nullptr) continue;
    PetscInt size = 0;
    const PetscInt* points = nullptr;
    call(ISGetLocalSize(stratum, &size));
    call(ISGetIndices(stratum, &points));
    for (PetscInt k = 0; k < size; ++k)
      if (points[k] >= first && points[k] - first < static_cast<PetscInt>(count))
        values[static_cast<std::size_t>(points[k] - first)] = stratum_values[s];
    call(ISRestoreIndices(stratum, &points));
    call(ISDestroy(&stratum));
  }
  call(ISRestoreIndices(strata, &stratum_values));
  call(ISDestroy(&strata));
  return values;
}

LocalMesh::LocalMesh(DM dm) {
  PetscInt first = 0, end = 0;
  call(DMPlexGetDepthStratum(dm, 0, &first, &end));
  const VertexCoordinates coordinates(dm);
  points.resize(static_cast<std::size_t>(end - first));
  if (coordinates.values() != nullptr && end > first) {
    const PetscScalar* values = nullptr;
    call(VecGetArrayRead(coordinates.values(), &values));
    for (PetscInt v = first; v < end; ++v) {
      const PetscScalar* at = values + coordinates.at(v);
      points[static_cast<std::size_t>(v - first)] = {at[0], at[1], at[2]};
    }
    call(VecRestoreArrayRead(coordinates.values(), &values));
  }
  PetscInt first_tet = 0, end_tet = 0;
  call(DMPlexGetHeightStratum(dm, 0, &first_tet, &end_tet));
  tets.reserve(static_cast<std::size_t>(end_tet - first_tet));
  for (PetscInt tet = first_tet; tet < end_tet; ++tet) {
    const auto [a, c, b, d] = corners_of(dm, tet, first);
    tets.push_back({a, b, c, d});
  }
}

void set_points(DM dm, const std::vector<Point>& points) {
  const VertexCoordinates coordinates(dm);
  PetscInt first = 0, end = 0;
  call(DMPlexGetDepthStratum(dm, 0, &first, &end));
  PetscScalar* values = nullptr;
  call(VecGetArray(coordinates.values(), &values));
  for (PetscInt v = first; v < end; ++v) {
    PetscScalar* at = values + coordinates.at(v);
    const Point& p = points[static_cast<std::size_t>(v - first)];
    at[0] = p.x;
    at[1] = p.y;
    at[2] = p.z;
  }
  call(VecRestoreArray(coordinates.values(), &values));
  call(DMSetCoordinatesLocal(dm, coordinates.values()));  // the global coordinates are outdated now
}

std::array<Index, 4> corners_of(DM dm, PetscInt tet, PetscInt first_vertex) {
  return closure_vertices<4>(dm, tet, first_vertex);
}
std::array<Index, 3> corners_of_face(DM dm, PetscInt face, PetscInt first_vertex) {
  return closure_vertices<3>(dm, face, first_vertex);
}
std::array<Index, 2> ends_of_edge(DM dm, PetscInt edge, PetscInt first_vertex) {
  const PetscInt* cone = nullptr;
  call(DMPlexGetCone(dm, edge, &cone));
  return {static_cast<Index>(cone[0] - first_vertex), static_cast<Index>(cone[1] - first_vertex)};
}

}  // namespace collarmesh::distributed
