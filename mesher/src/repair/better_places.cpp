#include "repair/better_places.h"

#include <algorithm>
#include <array>
#include <utility>

#include "common/distance_tree.h"
#include "repair/changes.h"

namespace collarmesh::repairing {

namespace {

using namespace facets;

// Returns for each place (connected changed triangles, see `Changes`) the sum of the costs of its troubles. A
// trouble belongs to the place of the nearest changed triangle, if that is within `reach`.
std::vector<double> costs(const ComplexDraft& draft, const std::vector<Index>& place_of, Index places,
                          const std::vector<Trouble>& troubles, double reach) {
  std::vector<double> cost(places, 0);
  std::vector<std::array<Point, 3>> triangles;
  std::vector<Index> place;
  for (Index t = 0; t < place_of.size(); ++t) {
    if (place_of[t] == none) continue;
    triangles.push_back({draft.corner(t, 0), draft.corner(t, 1), draft.corner(t, 2)});
    place.push_back(place_of[t]);
  }
  if (triangles.empty()) return cost;
  const DistanceTree tree(std::move(triangles));
  for (const Trouble& trouble : troubles) {
    const DistanceTree::Nearest nearest = tree.nearest(trouble.where);
    if (nearest.distance <= reach) cost[place[nearest.triangle]] += trouble.cost;
  }
  return cost;
}

}  // namespace

BetterPlaces better_places(const ComplexDraft& before, const std::vector<Trouble>& troubles_before,
                           const ComplexDraft& after, const std::vector<Trouble>& troubles_after,
                           double reach) {
  const Changes changes(before, after);
  const std::vector<double> cost_before =
      costs(before, changes.place_of_gone(), changes.places(), troubles_before, reach);
  const std::vector<double> cost_after =
      costs(after, changes.place_of_come(), changes.places(), troubles_after, reach);
  std::vector<bool> taken_back(changes.places());
  for (Index p = 0; p < changes.places(); ++p) taken_back[p] = cost_after[p] > cost_before[p];
  BetterPlaces result;
  result.places = changes.places();
  result.draft = without_what_meets(changes, taken_back);
  std::vector<bool> told(changes.places(), false);
  for (Index t = 0; t < before.triangles.size(); ++t) {
    const Index p = changes.place_of_gone()[t];
    if (p == none || !taken_back[p] || told[p]) continue;
    told[p] = true;
    result.taken_back.push_back(before.corner(t, 0));
  }
  return result;
}

}  // namespace collarmesh::repairing
