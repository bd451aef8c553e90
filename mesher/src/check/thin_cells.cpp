// Which tets may exceed the radius-edge bound because their angles are bounded instead, and by what.
#include <algorithm>

#include "check/subject.h"
#include "collarmesh/plc_builder.h"

namespace collarmesh::checks {

namespace {

constexpr double slack = 1e-9;  // relative

}  // namespace

ThinCells::ThinCells(const Subject& subject)
    : smallest_(subject.options.bounds.thin_angle),
      marks_(subject.mesh.tet_thin),
      all_(marks_.empty() && subject.mesh.features.empty()) {
  if (!(smallest_ > 0) || (marks_.empty() && !all_)) return;
  const Plc& plc = subject.plc;
  std::vector<double> of_curve(plc.curves.size(), smallest_);
  const auto lower_at_vertex = [&](Index vertex, double bound) {
    if (vertex == none || subject.match.vertex_point[vertex] == none) return;
    double& least = at_point_[subject.match.vertex_point[vertex]];
    least = std::min(least, bound);
  };
  for (const Crease& crease : find_creases(plc, 2 * smallest_)) {
    at_point_.resize(subject.mesh.points.size(), smallest_);
    const double bound = 0.5 * crease.angle;
    lower_at_vertex(crease.vertex, bound);
    if (crease.curve == none) continue;
    of_curve[crease.curve] = std::min(of_curve[crease.curve], bound);
    for (const Index end : plc.curves[crease.curve].ends) lower_at_vertex(end, bound);
  }
  if (at_point_.empty()) return;
  for (Index e = 0; e < subject.mesh.edges.size(); ++e) {
    const Index curve = subject.match.edge_curve[e];
    if (curve == none) continue;
    for (const Index p : subject.mesh.edges[e]) at_point_[p] = std::min(at_point_[p], of_curve[curve]);
  }
}

bool ThinCells::claimed(Index tet) const {
  return smallest_ > 0 && (all_ || (tet < marks_.size() && marks_[tet] != 0));
}

double ThinCells::smallest_angle(const std::array<Index, 4>& tet) const {
  double least = smallest_;
  if (!at_point_.empty())
    for (const Index p : tet) least = std::min(least, at_point_[p]);
  return least;
}

bool ThinCells::are_bounded(const TetQuality& quality, double face_angle,
                            const std::array<Index, 4>& tet) const {
  return quality.min_dihedral >= smallest_angle(tet) * (1 - slack) &&
         quality.max_dihedral <= largest_angle * (1 + slack) && face_angle <= largest_angle * (1 + slack);
}

}  // namespace collarmesh::checks
