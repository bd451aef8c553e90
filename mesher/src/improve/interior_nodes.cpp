#include "improve/interior_nodes.h"

#include <algorithm>
#include <vector>

#include "common/cell_shapes.h"
#include "improve/operations.h"
#include "improve/replace_tets.h"

namespace collarmesh::improvement {

namespace {

/// The rule of thin tets, with two differences: a tet without an interior node is worse than any other, and
/// the cells of collars may be replaced.
class InteriorRule final : public ShapeRule {
 public:
  InteriorRule(const Workpiece& workpiece, const Bounds& bounds)
      : thin_(workpiece.plc, workpiece.complex.mesh(), bounds.thin_angle, bounds.reserve, workpiece.forced,
              bounds.tets_across()),
        cells_(workpiece.plc, workpiece.complex.mesh(), bounds),
        rule_(thin_, cells_) {}

  double quality(const Corners& p, const std::array<Index, 4>& corners) const override {
    return rule_.quality(p, corners);
  }
  bool allows(const Corners&, const std::array<Index, 4>&, double) const override { return true; }
  const AngleRule* by_angles() const override { return &rule_; }
  bool dissolves_collars() const override { return true; }

  const ThinRule& of_thin_tets() const { return rule_; }
  bool is_to_go(const TetComplex::Tet& tet) const {
    return tet.alive && cells_.lacks_interior_node(tet.corners);
  }

 private:
  ThinShape thin_;
  CellBounds cells_;
  ThinRule rule_;
};

std::vector<Index> tets_to_go(const Workpiece& workpiece, const InteriorRule& rule) {
  std::vector<Index> found;
  for (Index t = 0; t < workpiece.complex.size(); ++t)
    if (rule.is_to_go(workpiece.complex[t])) found.push_back(t);
  return found;
}

/// Returns the removal of an edge if it leaves tets within the bounds; otherwise the change that leaves the
/// best tets.
Change change_for(Operations& operations, const TetComplex& complex, Index tet) {
  constexpr double good = 1;
  const std::array<Index, 4> corners = complex[tet].corners;
  Change change;
  operations.remove_best_edge(tet, change);
  if (change.kind != Change::Kind::none && change.quality >= good) return change;
  for (const auto& [i, j] : cell_shapes::corner_pairs)
    if (!complex.on_faces(corners[i], corners[j]))
      operations.split_edge(corners[i], corners[j], CellBounds::forbidden, change);
  if (change.kind != Change::Kind::none && change.quality >= good) return change;
  operations.insert_in_cavity(tet, CellBounds::forbidden, change);
  return change;
}

}  // namespace

void insert_interior_nodes(Workpiece& workpiece, const Bounds& bounds, InteriorNodesReport& report) {
  workpiece.complex.forget_balls();
  const InteriorRule rule(workpiece, bounds);
  Operations operations(workpiece, rule);
  const std::vector<Index> tets = tets_to_go(workpiece, rule);
  report.found += tets.size();
  for (const Index t : tets) {
    if (!rule.is_to_go(workpiece.complex[t])) continue;
    Change change = change_for(operations, workpiece.complex, t);
    if (change.kind == Change::Kind::none || change.quality <= CellBounds::forbidden) continue;
    ++(change.kind == Change::Kind::insertion ? report.inserted_nodes : report.removed_edges);
    workpiece.apply(std::move(change));
  }
}

void complete_interior_nodes(Workpiece& workpiece, const Bounds& bounds, InteriorNodesReport& report) {
  const InteriorRule rule(workpiece, bounds);
  const std::vector<Index> tets = tets_to_go(workpiece, rule);
  report.found += tets.size();
  std::vector<UnwantedTet> unwanted;
  unwanted.reserve(tets.size());
  for (const Index t : tets) unwanted.push_back({.tet = t});
  const std::size_t points = workpiece.complex.mesh().points.size();
  replace_tets(workpiece, unwanted, rule.of_thin_tets(), 1);
  report.inserted_nodes += workpiece.complex.mesh().points.size() - points;
  report.remaining = tets_to_go(workpiece, rule).size();
}

}  // namespace collarmesh::improvement
