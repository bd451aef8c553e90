// Finds the tets that are judged as cells of collars. A mark in a file does not suffice; it takes a crease of
// the complex.
#include <algorithm>

#include "check/subject.h"
#include "collarmesh/plc_builder.h"

namespace collarmesh::checks {

namespace {

class CreaseCorners {
 public:
  explicit CreaseCorners(const Subject& subject) : on_crease_(subject.mesh.points.size(), false) {
    const Plc& plc = subject.plc;
    std::vector<bool> is_crease(plc.curves.size(), false);
    const auto add_vertex = [&](Index vertex) {
      if (vertex != none && subject.match.vertex_point[vertex] != none)
        on_crease_[subject.match.vertex_point[vertex]] = true;
    };
    for (const Crease& crease : find_creases(plc, subject.options.bounds.crease_angle)) {
      add_vertex(crease.vertex);
      if (crease.curve == none) continue;
      is_crease[crease.curve] = true;
      for (const Index end : plc.curves[crease.curve].ends) add_vertex(end);
    }
    for (Index e = 0; e < subject.mesh.edges.size(); ++e) {
      const Index curve = subject.match.edge_curve[e];
      if (curve == none || !is_crease[curve]) continue;
      const auto& [a, b] = subject.mesh.edges[e];
      edges_.push_back(sorted(a, b));
      on_crease_[a] = on_crease_[b] = true;
    }
    std::sort(edges_.begin(), edges_.end());
  }

  /// 1: a star, 2: a book, 0: neither.
  std::uint8_t kind(const std::array<Index, 4>& tet) const {
    std::array<Index, 4> corners;
    const auto end =
        std::copy_if(tet.begin(), tet.end(), corners.begin(), [&](Index p) { return on_crease_[p]; });
    if (end - corners.begin() == 1) return 1;
    if (end - corners.begin() != 2) return 0;
    return std::binary_search(edges_.begin(), edges_.end(), sorted(corners[0], corners[1])) ? 2 : 0;
  }

 private:
  std::vector<bool> on_crease_;              // by mesh point
  std::vector<std::array<Index, 2>> edges_;  // on crease curves, sorted
};

}  // namespace

std::vector<std::uint8_t> collar_cells(const Subject& subject, Findings& findings) {
  const TetMesh& mesh = subject.mesh;
  const bool marked =
      std::any_of(mesh.tet_collar.begin(), mesh.tet_collar.end(), [](auto k) { return k != 0; });
  std::vector<std::uint8_t> cells(mesh.tets.size(), 0);
  if (!marked && !mesh.features.empty()) return cells;  // the mesh knows of none
  const CreaseCorners creases(subject);
  for (Index t = 0; t < mesh.tets.size(); ++t) {
    if (marked && mesh.tet_collar[t] == 0) continue;
    cells[t] = creases.kind(mesh.tets[t]);
    if (!marked || cells[t] == mesh.tet_collar[t]) continue;
    const Point where = 0.5 * (subject.point(mesh.tets[t][0]) + subject.point(mesh.tets[t][1]));
    findings.add(
        guarantee::collar_cells, where, {t},
        "Tet {} at {} is marked as a {} of a collar, but is none around a crease of the complex where "
        "features meet below {:.6g} degrees; give the crease angle that the mesh was made with, or "
        "take the mark off.",
        t, At{where}, mesh.tet_collar[t] == 1 ? "star" : "book", subject.options.bounds.crease_angle);
  }
  return cells;
}

}  // namespace collarmesh::checks
