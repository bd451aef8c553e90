#include "improve/workpiece.h"

#include <algorithm>

#include "improve/shape.h"

namespace collarmesh::improvement {

double Workpiece::quality(Index tet) const { return shape_quality(complex.corners(tet)); }

std::vector<bool> Workpiece::patches_to_keep(const Plc& plc, const TetMesh& mesh) {
  std::vector<bool> kept;
  for (const TetMesh::PeriodicFaces& faces : mesh.periodic) {
    kept.resize(plc.patches.size(), false);
    for (std::size_t patch = 0; patch < kept.size(); ++patch)
      for (const auto* tags : {&faces.first, &faces.second})
        if (std::binary_search(tags->begin(), tags->end(), plc.patches[patch].tag)) kept[patch] = true;
  }
  return kept;
}

const std::vector<Index>& Workpiece::apply(Change change) {
  auto& [old, created, old_faces, created_faces] = change.replacement;
  surfaces.take_samples(old_faces);
  if (change.kind == Change::Kind::move) {
    complex.star(change.vertex, changed_);
    complex.move_vertex(change.vertex, change.place);
    if (complex.mesh().features[change.vertex].dimension == 1) curves.moved(change.vertex, change.way);
    surfaces.give_samples(old_faces);
    return changed_;
  }
  if (change.kind == Change::Kind::insertion) {
    const Index vertex = complex.add_vertex(change.place, change.feature);
    for (auto& tet : created) std::replace(tet.corners.begin(), tet.corners.end(), Change::inserted, vertex);
    for (auto& face : created_faces)
      std::replace(face.corners.begin(), face.corners.end(), Change::inserted, vertex);
    if (change.feature.dimension == 1) {
      complex.divide_curve_edge(change.middle.ends[0], vertex, change.middle.ends[1]);
      curves.divided(vertex, change.middle);
    }
  }
  if (change.kind == Change::Kind::contraction && complex.mesh().features[change.vertex].dimension == 1) {
    const auto [before, after] = curves.neighbours(change.vertex);
    complex.join_curve_edges(before, change.vertex, after);
    curves.skipped(change.vertex);
  }
  const auto tets = complex.replace(change.replacement);
  changed_.assign(tets.begin(), tets.end());
  surfaces.give_samples(complex.created_faces());
  return changed_;
}

}  // namespace collarmesh::improvement
