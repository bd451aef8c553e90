// Finds the tets that may exceed the radius-edge bound because their angles are bounded instead, and the
// bounds on these angles.
#include <algorithm>
#include <cassert>

#include "check/mesh_to_check.h"
#include "collarmesh/plc_builder.h"

namespace collarmesh::checks {

namespace {

constexpr double thin_slack = 1e-9;  // relative tolerance

}  // namespace

std::vector<TetMesh::VertexFeature> features_of(const MeshToCheck& to_check) {
  assert(to_check.is_matched());
  std::vector<TetMesh::VertexFeature> features(to_check.mesh.points.size());
  for (Index f = 0; f < to_check.mesh.faces.size(); ++f)
    for (const Index p : to_check.mesh.faces[f])
      if (to_check.match.face_patch[f] != none) features[p] = {2, to_check.match.face_patch[f]};
  for (Index e = 0; e < to_check.mesh.edges.size(); ++e)
    for (const Index p : to_check.mesh.edges[e])
      if (to_check.match.edge_curve[e] != none) features[p] = {1, to_check.match.edge_curve[e]};
  for (Index v = 0; v < to_check.match.vertex_point.size(); ++v)
    if (const Index p = to_check.match.vertex_point[v]; p != none) features[p] = {0, v};
  return features;
}

ThinCells::ThinCells(const MeshToCheck& to_check)
    : mesh_(to_check.mesh),
      to_check_(to_check),
      smallest_(to_check.options.bounds.thin_angle),
      marks_(to_check.mesh.tet_thin),
      all_(marks_.empty() && to_check.mesh.features.empty()) {
  assert(to_check.is_matched());
  if (!(smallest_ > 0) || (marks_.empty() && !all_ && !to_check.coarsened)) return;
  const Plc& plc = to_check.plc;
  forced_.emplace(plc, features_of(to_check), mesh_.points, mesh_.faces, to_check.match.face_patch,
                  ForcedEdges::least_cosine_of_sides);
  const Bounds& bounds = to_check.options.bounds;
  if (bounds.thin_in_narrow_places_only)
    narrow_.emplace(plc, features_of(to_check), *forced_, bounds.crease_angle, 1 / bounds.radius_edge);
  std::vector<double> of_curve(plc.curves.size(), smallest_);
  const auto lower_at_vertex = [&](Index vertex, double bound) {
    if (vertex == none || to_check.match.vertex_point[vertex] == none) return;
    double& least = at_point_[to_check.match.vertex_point[vertex]];
    least = std::min(least, bound);
  };
  for (const Crease& crease : find_creases(plc, 2 * bounds.tets_across() * smallest_)) {
    at_point_.resize(to_check.mesh.points.size(), smallest_);
    const double bound = 0.5 * crease.angle / bounds.tets_across();
    lower_at_vertex(crease.vertex, bound);
    if (crease.curve == none) continue;
    of_curve[crease.curve] = std::min(of_curve[crease.curve], bound);
    for (const Index end : plc.curves[crease.curve].ends) lower_at_vertex(end, bound);
  }
  if (at_point_.empty()) return;
  for (Index e = 0; e < to_check.mesh.edges.size(); ++e) {
    const Index curve = to_check.match.edge_curve[e];
    if (curve == none) continue;
    for (const Index p : to_check.mesh.edges[e]) at_point_[p] = std::min(at_point_[p], of_curve[curve]);
  }
}

bool ThinCells::claimed(Index tet) const {
  return smallest_ > 0 && (all_ || (tet < marks_.size() && marks_[tet] != 0) ||
                           (to_check_.coarsened && to_check_.collar[tet] != 0));
}

bool ThinCells::has_place(Index tet) const {
  if (!narrow_ || to_check_.collar[tet] != 0) return true;
  const auto& [a, b, c, d] = mesh_.tets[tet];
  return narrow_->contain({mesh_.points[a], mesh_.points[b], mesh_.points[c], mesh_.points[d]}, {a, b, c, d});
}

double ThinCells::smallest_angle(Index tet) const {
  return std::min(smallest_angle_at(mesh_.tets[tet]), forced_angle(tet));
}

double ThinCells::forced_angle(Index tet) const {
  const auto& [a, b, c, d] = mesh_.tets[tet];
  return ForcedEdges::smallest_angle(forced_->narrowness(
             {mesh_.points[a], mesh_.points[b], mesh_.points[c], mesh_.points[d]}, {a, b, c, d})) /
         to_check_.options.bounds.tets_across();
}

double ThinCells::smallest_angle_at(const std::array<Index, 4>& tet) const {
  double least = smallest_;
  if (!at_point_.empty())
    for (const Index p : tet) least = std::min(least, at_point_[p]);
  return least;
}

bool ThinCells::are_bounded(const TetQuality& quality, double face_angle, Index tet) const {
  if (!(quality.max_dihedral <= largest_angle * (1 + thin_slack) &&
        face_angle <= largest_angle * (1 + thin_slack)))
    return false;
  return !is_forced(quality, tet) || quality.min_dihedral >= forced_angle(tet) * (1 - thin_slack);
}

bool ThinCells::is_forced(const TetQuality& quality, Index tet) const {
  return quality.min_dihedral < smallest_angle_at(mesh_.tets[tet]) * (1 - thin_slack);
}

}  // namespace collarmesh::checks
