#include "check/patch_topology.h"

#include <algorithm>
#include <numeric>

#include "common/sort_uniquely.h"

namespace collarmesh::checks {

CurveUses::CurveUses(const MeshToCheck& to_check)
    : plc_(to_check.plc), edges_by_curve_(to_check.match.edge_curve, to_check.plc.curves.size()) {
  std::vector<bool> at_beginning(plc_.points.size(), false);
  for (const Plc::Curve& curve : plc_.curves)
    at_beginning[curve.points[0]] = at_beginning[curve.points[1]] = true;
  for (const Plc::Triangle& t : plc_.triangles)
    for (unsigned i = 0; i < 3; ++i) {
      const auto [a, b] = sorted(t.points[i], t.points[(i + 1) % 3]);
      if (at_beginning[a] && at_beginning[b]) complex_edges_.push_back({a, b, t.patch});
    }
  std::sort(complex_edges_.begin(), complex_edges_.end());
  for (Index e = 0; e < to_check.mesh.edges.size(); ++e)
    if (to_check.match.edge_curve[e] != none)
      mesh_edges_.push_back(
          {sorted(to_check.mesh.edges[e][0], to_check.mesh.edges[e][1]), to_check.match.edge_curve[e]});
  std::sort(mesh_edges_.begin(), mesh_edges_.end());
}

std::size_t CurveUses::triangles_at(Index curve, Index patch) const {
  const auto& points = plc_.curves[curve].points;
  const auto [a, b] = sorted(points[0], points[1]);
  const auto [first, last] =
      std::equal_range(complex_edges_.begin(), complex_edges_.end(), std::array{a, b, patch});
  return static_cast<std::size_t>(last - first);
}

Index CurveUses::curve_of(const std::array<Index, 2>& edge) const {
  const auto found = std::lower_bound(mesh_edges_.begin(), mesh_edges_.end(), CurveEdge{edge, none});
  return found != mesh_edges_.end() && found->ends == edge ? found->curve : none;
}

namespace {

class TopologyCheck {
 public:
  TopologyCheck(const MeshToCheck& to_check, Index patch, const std::vector<Index>& faces,
                const CurveUses& uses, Findings& findings)
      : to_check_(to_check),
        id_(patch),
        patch_(to_check.plc.patches[patch]),
        faces_(faces),
        uses_(uses),
        findings_(findings),
        fans_(3 * faces.size()) {
    std::iota(fans_.begin(), fans_.end(), Index{0});
    for (Index place = 0; place < faces_.size(); ++place) add_sides(place);
    std::sort(sides_.begin(), sides_.end());
  }

  void run() {
    for (std::size_t i = 0, j = 0; i < sides_.size(); i = j) {
      for (j = i; j < sides_.size() && sides_[j].ends == sides_[i].ends;) ++j;
      check_edge(i, j);
      for (std::size_t k = i + 1; k < j; ++k) join_fans(sides_[i], sides_[k]);
    }
    check_curves();
    check_fans();
  }

 private:
  void add_sides(Index place) {
    const Index face = faces_[place];
    const auto& f = to_check_.mesh.faces[face];
    for (unsigned i = 0; i < 3; ++i) {
      const Index a = f[i], b = f[(i + 1) % 3];
      sides_.push_back({sorted(a, b), place, face, (a < b) != reversed(to_check_, face)});
    }
  }

  // Checks the faces at an edge. If the edge lies on a curve of the patch, it must have as many faces of the
  // patch as the complex has triangles of the patch there; otherwise two. If there are two, they must pass
  // the edge in opposite directions.
  void check_edge(std::size_t first, std::size_t last) {
    const PatchEdge& side = sides_[first];
    const Index curve = uses_.curve_of(side.ends);
    const bool of_patch = curve != none && to_check_.plc.curve_on_patch(curve, id_);
    const std::size_t expected = of_patch ? uses_.triangles_at(curve, id_) : 2;
    const Point where = to_check_.midpoint(side.ends);
    if (last - first == expected) {
      if (expected == 2 && side.ascending == sides_[first + 1].ascending)
        findings_.add(guarantee::patch_orientation, where, {side.face, sides_[first + 1].face},
                      "Faces {} and {} of patch {} (tag {}) are turned against each other at {}; turn one.",
                      side.face, sides_[first + 1].face, id_, patch_.tag, At{where});
      return;
    }
    if (of_patch)
      findings_.add(guarantee::patch_border, where, {id_, side.ends[0], side.ends[1]},
                    "Patch {} (tag {}) has {} faces at the edge of points {} and {} on its curve {} at {}, "
                    "but {} in the complex; faces are missing or tagged with another patch.",
                    id_, patch_.tag, last - first, side.ends[0], side.ends[1], curve, At{where}, expected);
    else if (last - first == 1)
      findings_.add(guarantee::patch_border, where, {id_, side.face},
                    "Patch {} (tag {}) ends at the edge of points {} and {} at {}, where it has no curve "
                    "in the complex; faces or edges are missing or tagged with another feature.",
                    id_, patch_.tag, side.ends[0], side.ends[1], At{where});
    else
      findings_.add(
          guarantee::patch_manifold, where, {id_, side.face},
          "Patch {} (tag {}) has {} faces at the edge of points {} and {} at {}; a surface has two.", id_,
          patch_.tag, last - first, side.ends[0], side.ends[1], At{where});
  }

  // Checks that every mesh edge on a curve of the patch has a face of the patch, if the complex has one
  // there.
  void check_curves() {
    for (const Index curve : patch_.curves) {
      const std::size_t expected = uses_.triangles_at(curve, id_);
      if (expected == 0) continue;
      for (auto e = uses_.edges().begin(curve); e != uses_.edges().end(curve); ++e) {
        const auto& edge = to_check_.mesh.edges[*e];
        const auto ends = sorted(edge[0], edge[1]);
        const auto side = std::lower_bound(sides_.begin(), sides_.end(), PatchEdge{ends, 0, 0, false});
        if (side != sides_.end() && side->ends == ends) continue;
        const Point where = to_check_.midpoint(ends);
        findings_.add(guarantee::patch_border, where, {id_, *e},
                      "Patch {} (tag {}) has no face at edge {} of its curve {} at {}; faces are missing or "
                      "tagged with "
                      "another patch.",
                      id_, patch_.tag, *e, curve, At{where});
      }
    }
  }

  // Returns the fan of a face's corner: corners of faces that are connected around their point form one fan
  // (union-find over the corners).
  Index fan(Index corner) {
    while (fans_[corner] != corner) corner = fans_[corner] = fans_[fans_[corner]];
    return corner;
  }
  Index corner_at(Index place, Index point) const {
    const auto& f = to_check_.mesh.faces[faces_[place]];
    return 3 * place + static_cast<Index>(std::find(f.begin(), f.end(), point) - f.begin());
  }
  void join_fans(const PatchEdge& a, const PatchEdge& b) {
    for (const Index point : a.ends) {
      const Index i = fan(corner_at(a.place, point)), j = fan(corner_at(b.place, point));
      fans_[std::max(i, j)] = std::min(i, j);
    }
  }

  // Checks that there is one fan at each point that is no vertex of the complex.
  void check_fans() {
    std::vector<std::array<Index, 2>> fans;  // point, fan
    for (Index place = 0; place < faces_.size(); ++place)
      for (unsigned i = 0; i < 3; ++i)
        fans.push_back({to_check_.mesh.faces[faces_[place]][i], fan(3 * place + i)});
    sort_uniquely(fans);
    for (std::size_t i = 1; i < fans.size(); ++i) {
      const Index point = fans[i][0];
      if (fans[i - 1][0] != point || (i > 1 && fans[i - 2][0] == point) || is_vertex(point)) continue;
      findings_.add(
          guarantee::patch_manifold, to_check_.point(point), {id_, point},
          "The faces of patch {} (tag {}) touch in point {} at {} without sharing an edge; the surface is "
          "pinched there, use a smaller distance or size.",
          id_, patch_.tag, point, At{to_check_.point(point)});
    }
  }

  bool is_vertex(Index point) const {
    const auto& vertices = patch_.vertices;
    return std::any_of(vertices.begin(), vertices.end(),
                       [&](Index v) { return to_check_.match.vertex_point[v] == point; });
  }

  const MeshToCheck& to_check_;
  Index id_;
  const Plc::Patch& patch_;
  const std::vector<Index>& faces_;
  const CurveUses& uses_;
  Findings& findings_;
  std::vector<PatchEdge> sides_;
  std::vector<Index> fans_;  // parents of the union-find, by corner 3 * place + i
};

}  // namespace

void check_patch_topology(const MeshToCheck& to_check, Index patch, const std::vector<Index>& faces,
                          const CurveUses& uses, Findings& findings) {
  TopologyCheck(to_check, patch, faces, uses, findings).run();
}

}  // namespace collarmesh::checks
