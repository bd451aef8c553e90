#include "remesh/editable_mesh.h"

#include <algorithm>
#include <cassert>

#include "delaunay/predicates.h"

namespace collarmesh::remeshing {

void EditableMesh::store_marked(const Bounds& bounds) {
  store();
  mark_cells(complex.mesh(), plc, bounds);
}

bool EditableMesh::stays_oriented(const Change& change) const {
  const bool moves = change.kind == Change::Kind::move, inserts = change.kind == Change::Kind::insertion;
  const Index placed = moves ? change.vertex : Change::inserted;
  const auto at = [&](Index v) {
    return (moves || inserts) && v == placed ? change.place : complex.mesh().points[v];
  };
  const auto is_positive = [&](const std::array<Index, 4>& v) {
    return predicates::orientation(at(v[0]), at(v[1]), at(v[2]), at(v[3])) > 0;
  };
  if (!moves)
    return std::ranges::all_of(change.replacement.created,
                               [&](const auto& tet) { return is_positive(tet.corners); });
  std::vector<Index> star;
  complex.star(change.vertex, star);
  return std::ranges::all_of(star, [&](Index t) { return is_positive(complex[t].corners); });
}

std::vector<bool> EditableMesh::patches_to_keep(const Plc& plc, const TetMesh& mesh) {
  std::vector<bool> kept;
  for (const TetMesh::PeriodicFaces& faces : mesh.periodic) {
    kept.resize(plc.patches.size(), false);
    for (std::size_t patch = 0; patch < kept.size(); ++patch)
      for (const auto* tags : {&faces.first, &faces.second})
        if (std::ranges::binary_search(*tags, plc.patches[patch].tag)) kept[patch] = true;
  }
  return kept;
}

const std::vector<Index>& EditableMesh::apply(Change change) {
  auto& [old, created, old_faces, created_faces] = change.replacement;
  surfaces.take_samples(old_faces);
  if (change.kind == Change::Kind::move) {
    assert(complex.in_use(change.vertex));
    complex.star(change.vertex, changed_);
    complex.move_vertex(change.vertex, change.place);
    if (complex.mesh().features[change.vertex].dimension == 1) curves.moved(change.vertex, change.way);
    surfaces.give_samples(old_faces);
    return changed_;
  }
  if (change.kind == Change::Kind::insertion) {
    const Index vertex = complex.add_vertex(change.place, change.feature);
    for (auto& tet : created) std::ranges::replace(tet.corners, Change::inserted, vertex);
    for (auto& face : created_faces) std::ranges::replace(face.corners, Change::inserted, vertex);
    if (change.feature.dimension == 1) {
      complex.divide_curve_edge(change.middle.ends[0], vertex, change.middle.ends[1]);
      curves.divided(vertex, change.middle);
    }
  }
  if (change.kind == Change::Kind::collapse && complex.mesh().features[change.vertex].dimension == 1) {
    const auto [before, after] = curves.neighbours(change.vertex);
    complex.join_curve_edges(before, change.vertex, after);
    curves.skipped(change.vertex);
  }
  const auto tets = complex.replace(change.replacement);
  changed_.assign(tets.begin(), tets.end());
  surfaces.give_samples(complex.created_faces());
  return changed_;
}

}  // namespace collarmesh::remeshing
