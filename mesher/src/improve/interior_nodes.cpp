#include "improve/improve_edited.h"

#include <cassert>
#include <vector>

#include "common/cell_shapes.h"
#include "remesh/operations.h"
#include "remesh/replace_tets.h"

namespace collarmesh::remeshing::improvement {

namespace {

/// The rule of thin tets, except that cells of collars may be replaced. With bounds that require interior
/// nodes, a tet without one is worse than any tet with one.
class InteriorRule final : public ShapeRule {
 public:
  InteriorRule(const EditableMesh& edited, const Bounds& bounds) : rule_(edited.tet_bounds(bounds)) {}

  double quality(const Corners& p, const std::array<Index, 4>& corners) const override {
    return rule_.quality(p, corners);
  }
  bool allows(const Corners&, const std::array<Index, 4>&, double) const override { return true; }
  const AngleRule* by_angles() const override { return &rule_; }
  bool dissolves_collars() const override { return true; }

  const ThinRule& of_thin_tets() const { return rule_; }
  bool is_to_go(const TetComplex::Tet& tet) const {
    return tet.alive && rule_.bounds().cells.lacks_interior_node(tet.corners);
  }

 private:
  ThinRule rule_;
};

std::vector<Index> tets_to_go(const EditableMesh& edited, const InteriorRule& rule) {
  std::vector<Index> found;
  for (Index t = 0; t < edited.complex.size(); ++t)
    if (rule.is_to_go(edited.complex[t])) found.push_back(t);
  return found;
}

/// Returns the change of this tet that leaves the best tets. Tries removals of edges, then insertions on
/// edges, then insertions in cavities, and stops at a kind that leaves only tets within the bounds.
Change change_for(Operations& operations, const TetComplex& complex, Index tet) {
  constexpr double good = 1;
  const std::array<Index, 4> corners = complex[tet].corners;
  Change change;
  operations.remove_best_edge(tet, change);
  if (!change.is_none() && change.quality >= good) return change;
  for (const auto& [i, j] : cell_shapes::corner_pairs)
    if (!complex.on_faces(corners[i], corners[j]))
      operations.split_edge(corners[i], corners[j], CellBounds::forbidden, change);
  if (!change.is_none() && change.quality >= good) return change;
  operations.insert_in_cavity(tet, CellBounds::forbidden, change);
  return change;
}

}  // namespace

void insert_interior_nodes(EditableMesh& edited, const Bounds& bounds, InteriorNodesReport& report) {
  assert(edited.complex.mesh().features.size() == edited.complex.mesh().points.size());
  edited.complex.forget_balls();
  const InteriorRule rule(edited, bounds);
  Operations operations(edited, rule);
  const std::vector<Index> tets = tets_to_go(edited, rule);
  report.found += tets.size();
  for (const Index t : tets) {
    if (!rule.is_to_go(edited.complex[t])) continue;
    Change change = change_for(operations, edited.complex, t);
    if (change.is_none() || change.quality <= CellBounds::forbidden) continue;
    ++(change.kind == Change::Kind::insertion ? report.inserted_nodes : report.removed_edges);
    edited.apply(std::move(change));
  }
}

void complete_interior_nodes(EditableMesh& edited, const Bounds& bounds, InteriorNodesReport& report) {
  const InteriorRule rule(edited, bounds);
  const std::vector<Index> tets = tets_to_go(edited, rule);
  report.found += tets.size();
  std::vector<UnwantedTet> unwanted;
  unwanted.reserve(tets.size());
  for (const Index t : tets) unwanted.push_back({.tet = t});
  const std::size_t points = edited.complex.mesh().points.size();
  replace_tets(edited, unwanted, rule.of_thin_tets(), 1);
  report.inserted_nodes += edited.complex.mesh().points.size() - points;
  report.remaining = tets_to_go(edited, rule).size();
}

}  // namespace collarmesh::remeshing::improvement
