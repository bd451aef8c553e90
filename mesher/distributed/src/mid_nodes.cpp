#include "mid_nodes.h"

#include <stdexcept>

#include "calls.h"

namespace collarmesh::distributed {

Edges::Edges(DM dm) : dm_(dm) {
  PetscInt end = 0, first_vertex = 0;
  call(DMPlexGetDepthStratum(dm, 1, &first_, &end));
  call(DMPlexGetDepthStratum(dm, 0, &first_vertex, nullptr));
  ends_.reserve(static_cast<std::size_t>(end - first_));
  for (PetscInt e = first_; e < end; ++e) ends_.push_back(ends_of_edge(dm, e, first_vertex));
}

Index Edges::edge_of(const PetscInt* edges, std::size_t count, Index a, Index b) const {
  for (std::size_t k = 0; k < count; ++k) {
    const auto edge = static_cast<Index>(edges[k] - first_);
    const auto& [c, d] = ends_[edge];
    if ((a == c && b == d) || (a == d && b == c)) return edge;
  }
  throw std::logic_error("two corners of a cell have no edge");
}

std::array<Index, 3> Edges::of_face(PetscInt face, const std::array<Index, 3>& corners) const {
  const PetscInt* edges = nullptr;
  call(DMPlexGetCone(dm_, face, &edges));
  std::array<Index, 3> found;
  for (std::size_t k = 0; k < 3; ++k) found[k] = edge_of(edges, 3, corners[k], corners[(k + 1) % 3]);
  return found;
}

std::array<Index, 6> Edges::of_tet(PetscInt tet, const std::array<Index, 4>& corners) const {
  std::array<PetscInt, 12> edges;  // edges of its faces; each edge occurs twice
  const PetscInt* faces = nullptr;
  call(DMPlexGetCone(dm_, tet, &faces));
  for (std::size_t f = 0; f < 4; ++f) {
    const PetscInt* of_face = nullptr;
    call(DMPlexGetCone(dm_, faces[f], &of_face));
    for (std::size_t k = 0; k < 3; ++k) edges[3 * f + k] = of_face[k];
  }
  std::array<Index, 6> found;
  for (std::size_t k = 0; k < 6; ++k)
    found[k] = edge_of(edges.data(), edges.size(), corners[tet_edges[k][0]], corners[tet_edges[k][1]]);
  return found;
}

std::vector<Point> Edges::nodes() const {
  Vec coordinates = nullptr;
  PetscSection section = nullptr;
  call(DMGetCoordinatesLocal(dm_, &coordinates));
  call(DMGetCoordinateSection(dm_, &section));
  const PetscScalar* values = nullptr;
  call(VecGetArrayRead(coordinates, &values));
  std::vector<Point> nodes(ends_.size());
  for (std::size_t e = 0; e < nodes.size(); ++e) {
    PetscInt offset = 0;
    call(PetscSectionGetOffset(section, first_ + static_cast<PetscInt>(e), &offset));
    nodes[e] = {values[offset], values[offset + 1], values[offset + 2]};
  }
  call(VecRestoreArrayRead(coordinates, &values));
  return nodes;
}

void Edges::set_nodes(const std::vector<Point>& nodes) {
  Vec coordinates = nullptr;
  PetscSection section = nullptr;
  call(DMGetCoordinatesLocal(dm_, &coordinates));
  call(DMGetCoordinateSection(dm_, &section));
  PetscScalar* values = nullptr;
  call(VecGetArray(coordinates, &values));
  for (std::size_t e = 0; e < nodes.size(); ++e) {
    PetscInt offset = 0;
    call(PetscSectionGetOffset(section, first_ + static_cast<PetscInt>(e), &offset));
    values[offset] = nodes[e].x;
    values[offset + 1] = nodes[e].y;
    values[offset + 2] = nodes[e].z;
  }
  call(VecRestoreArray(coordinates, &values));
  call(DMSetCoordinatesLocal(dm_, coordinates));
}

}  // namespace collarmesh::distributed
