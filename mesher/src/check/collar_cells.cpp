// Finds the tets that are judged as cells of collars. A mark in a file does not suffice: the tet must also
// lie at a crease of the complex.
#include <algorithm>
#include <cassert>

#include "check/mesh_to_check.h"
#include "collarmesh/plc_builder.h"

namespace collarmesh::checks {

namespace {

class CreaseCorners {
 public:
  explicit CreaseCorners(const MeshToCheck& to_check) : on_crease_(to_check.mesh.points.size(), false) {
    const Plc& plc = to_check.plc;
    std::vector<bool> is_crease(plc.curves.size(), false);
    const auto add_vertex = [&](Index vertex) {
      if (vertex != none && to_check.match.vertex_point[vertex] != none)
        on_crease_[to_check.match.vertex_point[vertex]] = true;
    };
    for (const Crease& crease : find_creases(plc, to_check.options.bounds.crease_angle)) {
      add_vertex(crease.vertex);
      if (crease.curve == none) continue;
      is_crease[crease.curve] = true;
      for (const Index end : plc.curves[crease.curve].ends) add_vertex(end);
    }
    for (Index e = 0; e < to_check.mesh.edges.size(); ++e) {
      const Index curve = to_check.match.edge_curve[e];
      if (curve == none || !is_crease[curve]) continue;
      const auto& [a, b] = to_check.mesh.edges[e];
      edges_.push_back(sorted(a, b));
      on_crease_[a] = on_crease_[b] = true;
    }
    std::sort(edges_.begin(), edges_.end());
  }

  /// Returns the kind of a tet in a mesh that was not coarsened: 1 in a star, 2 in a book, else 0. In such a
  /// mesh each vertex on a crease is the centre of a ball. A tet in a star has one corner on a crease, the
  /// centre of its ball; a tet in a book has two, the centres of two balls, joined by an edge on the crease.
  std::uint8_t kind_in_balls(const std::array<Index, 4>& tet) const {
    std::array<Index, 4> corners;
    const auto end =
        std::copy_if(tet.begin(), tet.end(), corners.begin(), [&](Index p) { return on_crease_[p]; });
    if (end - corners.begin() == 1) return 1;
    if (end - corners.begin() != 2) return 0;
    return is_edge(corners[0], corners[1]) ? 2 : 0;
  }
  /// Returns the kind of a tet in a coarsened mesh, where all tets that touch a crease belong to its collar:
  /// 2 if two corners are joined by an edge on a crease, else 1; 0 if the tet touches no crease.
  std::uint8_t kind_of_touching(const std::array<Index, 4>& tet) const {
    if (std::none_of(tet.begin(), tet.end(), [&](Index p) { return on_crease_[p]; })) return 0;
    for (unsigned i = 0; i < 4; ++i)
      for (unsigned j = 0; j < i; ++j)
        if (on_crease_[tet[i]] && on_crease_[tet[j]] && is_edge(tet[i], tet[j])) return 2;
    return 1;
  }

 private:
  bool is_edge(Index a, Index b) const {
    return std::binary_search(edges_.begin(), edges_.end(), sorted(a, b));
  }

  std::vector<bool> on_crease_;              // by mesh point
  std::vector<std::array<Index, 2>> edges_;  // edges on crease curves, sorted
};

bool any_of(const std::vector<std::uint8_t>& marks) {
  return std::any_of(marks.begin(), marks.end(), [](auto mark) { return mark != 0; });
}

bool is_coarsened(const TetMesh& mesh, const CreaseCorners& creases) {
  if (!mesh.collar_balls.empty()) return false;
  if (any_of(mesh.tet_thin)) return true;
  for (Index t = 0; t < mesh.tet_collar.size(); ++t)
    if (mesh.tet_collar[t] != 0 && creases.kind_in_balls(mesh.tets[t]) != mesh.tet_collar[t] &&
        creases.kind_of_touching(mesh.tets[t]) == mesh.tet_collar[t])
      return true;
  return false;
}

void add_wrong_mark(const MeshToCheck& to_check, Index tet, std::uint8_t kind, Findings& findings) {
  constexpr std::array names{"no cell", "a star (touching creases at corners only)",
                             "a book (with an edge on a crease)"};
  const Point where =
      0.5 * (to_check.point(to_check.mesh.tets[tet][0]) + to_check.point(to_check.mesh.tets[tet][1]));
  findings.add(
      guarantee::collar_cells, where, {tet},
      "Tet {} at {} is marked as {} of a collar, but should be {} (features that meet below {:.6g} "
      "degrees form a crease); give the crease angle that the mesh was made with, or correct the mark.",
      tet, At{where}, names[std::min<std::size_t>(to_check.mesh.tet_collar[tet], 2)], names[kind],
      to_check.options.bounds.crease_angle);
}

}  // namespace

void find_collar_cells(MeshToCheck& to_check, Findings& findings) {
  assert(to_check.is_matched());
  const TetMesh& mesh = to_check.mesh;
  const bool marked = any_of(mesh.tet_collar);
  to_check.collar.assign(mesh.tets.size(), 0);
  if (!marked && !mesh.features.empty() && !any_of(mesh.tet_thin)) return;  // the mesh has no collars
  const CreaseCorners creases(to_check);
  to_check.coarsened = is_coarsened(mesh, creases);
  for (Index t = 0; t < mesh.tets.size(); ++t) {
    if (marked && mesh.tet_collar[t] == 0 && !to_check.coarsened) continue;
    if (to_check.has_layers() && mesh.layers.tet_layer[t] > 0)
      continue;  // tets in layers belong to no collar
    to_check.collar[t] =
        to_check.coarsened ? creases.kind_of_touching(mesh.tets[t]) : creases.kind_in_balls(mesh.tets[t]);
    if (marked && to_check.collar[t] != mesh.tet_collar[t])
      add_wrong_mark(to_check, t, to_check.collar[t], findings);
  }
}

}  // namespace collarmesh::checks
