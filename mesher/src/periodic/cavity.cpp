#include "periodic/cavity.h"

#include <algorithm>
#include <cmath>

#include "common/contains.h"
#include "common/tet_sides.h"
#include "remesh/shape.h"

namespace collarmesh::periodicity {

// Makes the cavity of `tets`, all tets at a simplex (a vertex, an edge or a face). `is_of` tells the
// simplex's vertices. Faces of the mesh at the simplex are removed; their edges opposite a vertex of the
// simplex form the rim. The sides of the tets opposite a vertex of the simplex form the hull.
template <class IsOf>
Cavity CavityEditor::cavity_of(std::vector<Index> tets, const IsOf& is_of) const {
  Cavity cavity;
  cavity.tets = std::move(tets);
  for (const Index t : cavity.tets) {
    const TetComplex::Tet& tet = complex_[t];
    for (unsigned corner = 0; corner < 4; ++corner) {
      if (is_of(tet.corners[corner])) {
        cavity.hull.push_back({side_corners(tet.corners, corner), t});
        continue;
      }
      const Index face = tet.faces[corner];
      if (face == none || contains(cavity.faces, face)) continue;
      cavity.faces.push_back(face);
      const auto& corners = mesh_.faces[face];
      for (unsigned i = 0; i < 3; ++i)
        if (is_of(corners[i])) cavity.rim.push_back({{corners[(i + 1) % 3], corners[(i + 2) % 3]}, face});
    }
  }
  return cavity;
}

Cavity CavityEditor::around_vertex(Index vertex) const {
  if (complex_.pinched(vertex)) return {};
  std::vector<Index> star;
  complex_.star(vertex, star);
  return cavity_of(std::move(star), [=](Index v) { return v == vertex; });
}

Cavity CavityEditor::around_edge(Index a, Index b) const {
  const Index from = complex_.pinched(a) ? b : a, to = from == a ? b : a;
  if (complex_.pinched(from)) return {};
  std::vector<Index> star;
  complex_.star(from, star);
  std::erase_if(star, [&](Index t) { return !contains(complex_[t].corners, to); });
  return cavity_of(std::move(star), [=](Index v) { return v == a || v == b; });
}

Cavity CavityEditor::around_face(Index face) const {
  const auto corners = mesh_.faces[face];
  const auto free = std::ranges::find_if(corners, [&](Index v) { return !complex_.pinched(v); });
  if (free == corners.end()) return {};
  std::vector<Index> star;
  complex_.star(*free, star);
  std::erase_if(star, [&](Index t) {
    return !std::ranges::all_of(corners, [&](Index v) { return contains(complex_[t].corners, v); });
  });
  return cavity_of(std::move(star), [=](Index v) { return contains(corners, v); });
}

double CavityEditor::worst(const Cavity& cavity, const Point& apex, Index vertex) const {
  double worst = cavity.tets.empty() ? -1 : INFINITY;
  const auto see = [&](const std::array<Index, 3>& corners) {
    if (worst < least_quality || contains(corners, vertex)) return;
    worst = std::min(worst, remeshing::shape_quality({apex, at(corners[0]), at(corners[1]), at(corners[2])}));
  };
  for (const Cavity::Side& side : cavity.hull) see(side.corners);
  for (const TetComplex::NewFace& face : cavity.floor) see(face.corners);
  return worst < least_quality ? -1 : worst;
}

void CavityEditor::fill(const Cavity& cavity, Index apex) {
  TetComplex::Replacement replacement;
  replacement.old = cavity.tets;
  replacement.old_faces = cavity.faces;
  for (const auto& [corners, like] : cavity.hull)
    if (!contains(corners, apex))
      replacement.created.push_back({{apex, corners[0], corners[1], corners[2]}, like});
  for (const TetComplex::NewFace& face : cavity.floor) {
    replacement.created_faces.push_back(face);
    if (!contains(face.corners, apex))
      replacement.created.push_back(
          {{apex, face.corners[0], face.corners[1], face.corners[2]}, cavity.tets.front()});
  }
  for (const auto& [ends, like] : cavity.rim)
    if (!contains(ends, apex)) replacement.created_faces.push_back({{apex, ends[0], ends[1]}, like});
  complex_.replace(replacement);
}

Index CavityEditor::insert(const Cavity& cavity, const Point& apex, const TetMesh::VertexFeature& feature) {
  const Index vertex = complex_.add_vertex(apex, feature);
  fill(cavity, vertex);
  return vertex;
}

}  // namespace collarmesh::periodicity
