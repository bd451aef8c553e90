// Operations that replace the tets around two edges at once.
#include <algorithm>
#include <set>
#include <utility>

#include "common/cell_shapes.h"
#include "common/sort_uniquely.h"
#include "common/sorted.h"
#include "remesh/operations.h"
#include "remesh/polyhedron_filling.h"

namespace collarmesh::remeshing {

namespace {

constexpr std::size_t most_tets_around = 14, most_fillings = 400;

}  // namespace

void Operations::reconnect(Index tet, Change& change) {
  std::set<std::vector<Index>> tried;
  TetComplex::Ring first, second;
  for (const auto& [i, j] : cell_shapes::corner_pairs) {
    complex_.ring(tet, complex_[tet].corners[i], complex_[tet].corners[j], first);
    for (const Index beside : first.tets)
      for (const auto& [k, l] : cell_shapes::corner_pairs) {
        complex_.ring(beside, complex_[beside].corners[k], complex_[beside].corners[l], second);
        std::vector<Index> cavity = first.tets;
        cavity.insert(cavity.end(), second.tets.begin(), second.tets.end());
        sort_uniquely(cavity);
        if (cavity.size() > most_tets_around || !tried.insert(cavity).second) continue;
        refill(cavity, change);
      }
  }
}

// Proposes to fill the space of these tets with other tets, if the worst new tet is better than the worst old
// one and than the worst new tet of the proposal that `change` holds.
void Operations::refill(const std::vector<Index>& cavity, Change& change) {
  if (!find_cone_of_cavity(cavity)) return;
  double worst = INFINITY;
  Vector longest{0, 0, 0};
  std::vector<std::array<Index, 2>> edges;
  for (const Index t : cavity) {
    worst = std::min(worst, quality(t));
    const auto& corners = complex_[t].corners;
    for (const auto& [i, j] : cell_shapes::corner_pairs) {
      edges.push_back(sorted(corners[i], corners[j]));
      const Vector edge = complex_.edge(corners[i], corners[j]);
      if (squared_norm(edge) > squared_norm(longest)) longest = edge;
    }
  }
  std::ranges::sort(edges);
  const auto quality_of = [&](const std::array<Index, 4>& v, double above) {
    const double quality = new_quality(v, above);
    if (quality < 0) return quality;
    const bool allowed = std::ranges::all_of(cell_shapes::corner_pairs, [&](const EdgePlaces& edge) {
      const auto ends = sorted(v[edge[0]], v[edge[1]]);
      const auto& [a, b] = ends;
      return std::ranges::binary_search(edges, ends) || rule_.allows_edge(a, b, complex_.edge(a, b), longest);
    });
    return allowed ? quality : -1;
  };
  const double above = change.is_none() ? worst : std::max(worst, change.quality);
  std::vector<std::array<Index, 3>> hull = cone_.hull;
  for (auto& triangle : hull) std::swap(triangle[1], triangle[2]);
  const auto tets = fill_polyhedron(hull, above, quality_of, most_fillings);
  if (tets.empty()) return;
  Change made;
  made.kind = Change::Kind::edge_removal;
  made.quality = INFINITY;
  for (const auto& corners : tets) {
    made.quality = std::min(made.quality, new_quality(corners, above));
    made.replacement.created.push_back({corners, cavity.front()});
  }
  made.replacement.old = cavity;
  made.read = std::move(change.read);
  change = std::move(made);
}

}  // namespace collarmesh::remeshing
