#include "local_mesh.h"

#include <algorithm>
#include <stdexcept>

#include "calls.h"
#include "common/cell_shapes.h"
#include "common/sorted.h"

namespace collarmesh::distributed {

namespace {

/// The points of one depth of a DMPlex.
struct Stratum {
  Stratum(DM dm, PetscInt depth) { call(DMPlexGetDepthStratum(dm, depth, &first, &end)); }
  std::size_t size() const { return static_cast<std::size_t>(end - first); }
  PetscInt first = 0, end = 0;
};

/// Visits the vertices, and those edges that have coordinates, with their coordinates. Returns how many edges
/// it visited.
template <class Visit>
std::size_t for_each_place(DM dm, PetscScalar* values, const Visit& visit) {
  PetscSection section = nullptr;
  call(DMGetCoordinateSection(dm, &section));
  PetscInt first = 0, end = 0;  // the range of points in the section
  call(PetscSectionGetChart(section, &first, &end));
  std::size_t seen = 0, edges = 0;
  for (const PetscInt depth : {0, 1}) {
    const Stratum stratum(dm, depth);
    for (PetscInt point = std::max(first, stratum.first); point < std::min(end, stratum.end); ++point) {
      PetscInt size = 0, offset = 0;
      call(PetscSectionGetDof(section, point, &size));
      if (size == 0) continue;
      call(PetscSectionGetOffset(section, point, &offset));
      visit(seen++, values + offset);
      edges += static_cast<std::size_t>(depth);
    }
  }
  return edges;
}

/// The vertices and edges of a face or tet, with their numbers in the part of this rank, which begin at 0 for
/// vertices and for edges.
template <std::size_t corners>
struct Closure {
  static constexpr std::size_t edge_count = corners == 4 ? 6 : 3;

  Closure(DM dm, PetscInt cell) {
    const PetscInt first_vertex = Stratum(dm, 0).first, first_edge = Stratum(dm, 1).first;
    PetscInt count = 0;
    PetscInt* points = nullptr;  // the last ones are the edges and then the vertices
    call(DMPlexGetTransitiveClosure(dm, cell, PETSC_TRUE, &count, &points));
    const PetscInt* at = points + 2 * (static_cast<std::size_t>(count) - corners - edge_count);
    for (std::size_t k = 0; k < edge_count; ++k, at += 2) edges[k] = static_cast<Index>(*at - first_edge);
    for (std::size_t k = 0; k < corners; ++k, at += 2) vertices[k] = static_cast<Index>(*at - first_vertex);
    call(DMPlexRestoreTransitiveClosure(dm, cell, PETSC_TRUE, &count, &points));
  }

  std::array<Index, corners> vertices;
  std::array<Index, edge_count> edges;
};

/// Returns the nodes of the edges between corners, in the order of TetMesh.
template <std::size_t corners, std::size_t count>
std::array<Index, count> mid_nodes(const LocalMesh& mesh, const std::array<Index, corners>& cell,
                                   const std::array<Index, count>& edges) {
  std::array<Index, count> nodes;
  for (std::size_t k = 0; k < count; ++k) {
    const auto& [i, j] = cell_shapes::tet_edges[k];
    const std::array<Index, 2> wanted = sorted(cell[i], cell[j]);
    const auto found =
        std::find_if(edges.begin(), edges.end(), [&](Index e) { return sorted(mesh.ends[e]) == wanted; });
    if (found == edges.end()) throw std::logic_error("no edge joins two corners of a cell");
    nodes[k] = static_cast<Index>(mesh.vertices) + *found;
  }
  return nodes;
}

void read_points(DM dm, LocalMesh& mesh) {
  Vec coordinates = nullptr;
  call(DMGetCoordinatesLocal(dm, &coordinates));
  if (coordinates == nullptr) return;
  PetscScalar* values = nullptr;
  call(VecGetArray(coordinates, &values));
  const std::size_t nodes = for_each_place(dm, values, [&](std::size_t i, const PetscScalar* at) {
    if (i < mesh.points.size()) mesh.points[i] = {at[0], at[1], at[2]};
  });
  call(VecRestoreArray(coordinates, &values));
  if (nodes > 0) return;
  for (std::size_t e = 0; mesh.vertices + e < mesh.points.size(); ++e)
    mesh.points[mesh.vertices + e] = mesh.middle(e);
}

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

LocalMesh::LocalMesh(DM dm, int order) : dm_(dm) {
  const Stratum all_vertices(dm, 0);
  vertices = all_vertices.size();
  for (const PetscInt code : label_values(dm, feature_label, all_vertices.first, vertices))
    features.push_back(decoded(code));
  read_edges(order);
  points.resize(vertices + (order == 2 ? ends.size() : 0));
  read_points(dm, *this);
  read_faces(order);
  read_tets(order);
}

void LocalMesh::read_edges(int order) {
  const Stratum all_vertices(dm_, 0), all(dm_, 1);
  const std::vector<PetscInt> codes = label_values(dm_, feature_label, all.first, all.size()),
                              tags = label_values(dm_, "curve", all.first, all.size());
  for (std::size_t e = 0; e < codes.size(); ++e) {
    const PetscInt* cone = nullptr;
    call(DMPlexGetCone(dm_, all.first + static_cast<PetscInt>(e), &cone));
    ends.push_back(
        {static_cast<Index>(cone[0] - all_vertices.first), static_cast<Index>(cone[1] - all_vertices.first)});
    const VertexFeature feature = decoded(codes[e]);
    if (order == 2) features.push_back(feature);
    if (feature.dimension != 1 || feature.feature == none) continue;
    edge_number.push_back(e);
    edges.push_back(ends[e]);
    edge_curve.push_back(feature.feature);
    edge_tag.push_back(tags[e]);
    if (order == 2) edge_mid_nodes.push_back(static_cast<Index>(vertices + e));
  }
}

void LocalMesh::read_faces(int order) {
  const Stratum all(dm_, 2);
  const std::vector<PetscInt> codes = label_values(dm_, feature_label, all.first, all.size()),
                              tags = label_values(dm_, "patch", all.first, all.size());
  for (std::size_t f = 0; f < codes.size(); ++f) {
    const VertexFeature feature = decoded(codes[f]);
    if (feature.dimension != 2 || feature.feature == none) continue;
    const Closure<3> closure(dm_, all.first + static_cast<PetscInt>(f));
    face_number.push_back(f);
    faces.push_back(closure.vertices);
    face_patch.push_back(feature.feature);
    face_tag.push_back(tags[f]);
    if (order == 2) face_mid_nodes.push_back(mid_nodes(*this, closure.vertices, closure.edges));
  }
}

void LocalMesh::read_tets(int order) {
  PetscInt first = 0, end = 0;
  call(DMPlexGetHeightStratum(dm_, 0, &first, &end));
  for (PetscInt tet = first; tet < end; ++tet) {
    const Closure<4> closure(dm_, tet);
    const auto& [a, c, b, d] = closure.vertices;  // PETSc's tets are mirror images of ours
    tets.push_back({a, b, c, d});
    if (order == 2) tet_mid_nodes.push_back(mid_nodes(*this, tets.back(), closure.edges));
  }
  for (const PetscInt tag : label_values(dm_, "region", first, tets.size())) tet_tag.push_back(tag);
  for (const PetscInt kind : label_values(dm_, "collar", first, tets.size()))
    tet_collar.push_back(static_cast<std::uint8_t>(std::max<PetscInt>(kind, 0)));
}

void set_points(DM dm, const std::vector<Point>& points) {
  Vec coordinates = nullptr;
  call(DMGetCoordinatesLocal(dm, &coordinates));
  PetscScalar* values = nullptr;
  call(VecGetArray(coordinates, &values));
  for_each_place(dm, values, [&](std::size_t i, PetscScalar* at) {
    at[0] = points[i].x;
    at[1] = points[i].y;
    at[2] = points[i].z;
  });
  call(VecRestoreArray(coordinates, &values));
  call(DMSetCoordinatesLocal(dm, coordinates));  // makes PETSc discard the old global coordinates
}

std::array<Index, 3> corners_of_face(DM dm, PetscInt face) { return Closure<3>(dm, face).vertices; }

}  // namespace collarmesh::distributed
