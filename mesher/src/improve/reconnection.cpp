// Operations that replace the tets around two edges at once.
#include <algorithm>
#include <set>

#include "common/cell_shapes.h"
#include "improve/operations.h"
#include "improve/polyhedron_filling.h"

namespace collarmesh::improvement {

namespace {

constexpr std::size_t most_tets_around = 14, most_fillings = 400;

bool has(std::span<const Index> sorted, Index item) {
  return std::binary_search(sorted.begin(), sorted.end(), item);
}

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
        std::sort(cavity.begin(), cavity.end());
        cavity.erase(std::unique(cavity.begin(), cavity.end()), cavity.end());
        if (cavity.size() > most_tets_around || !tried.insert(cavity).second) continue;
        refill(cavity, change);
      }
  }
}

// Returns the triangles around these tets, oriented towards them; nothing if a face, curve or vertex of the
// mesh inside the space would be lost.
std::optional<std::vector<std::array<Index, 3>>> Operations::hull_of(std::span<const Index> cavity) const {
  std::vector<std::array<Index, 3>> hull;
  for (const Index t : cavity) {
    const TetComplex::Tet& tet = complex_[t];
    if (untouchable(tet)) return std::nullopt;
    for (unsigned corner = 0; corner < 4; ++corner) {
      if (tet.neighbours[corner] == none || !has(cavity, tet.neighbours[corner]))
        hull.push_back(face_below(tet.corners, corner));
      else if (tet.faces[corner] != none)
        return std::nullopt;
    }
  }
  const auto on_hull = [&](std::span<const Index> corners) {
    return std::ranges::any_of(hull, [&](const std::array<Index, 3>& triangle) {
      return std::ranges::all_of(corners, [&](Index v) { return std::ranges::count(triangle, v) > 0; });
    });
  };
  for (const Index t : cavity) {
    const auto& corners = complex_[t].corners;
    for (const Index v : corners)
      if (!on_hull({{v}})) return std::nullopt;
    for (const auto& [i, j] : cell_shapes::corner_pairs)
      if (complex_.on_curve(corners[i], corners[j]) && !on_hull({{corners[i], corners[j]}}))
        return std::nullopt;
  }
  return hull;
}

// Fills the space of these tets with others, if the worst new tet is better than the worst old one and than
// `change`.
void Operations::refill(const std::vector<Index>& cavity, Change& change) const {
  const auto hull = hull_of(cavity);
  if (!hull) return;
  double worst = INFINITY, longest = 0;
  std::vector<std::array<Index, 2>> edges;
  for (const Index t : cavity) {
    worst = std::min(worst, quality(t));
    const auto& corners = complex_[t].corners;
    for (const auto& [i, j] : cell_shapes::corner_pairs) {
      edges.push_back({std::min(corners[i], corners[j]), std::max(corners[i], corners[j])});
      longest = std::max(longest, squared_distance(mesh_.points[corners[i]], mesh_.points[corners[j]]));
    }
  }
  std::sort(edges.begin(), edges.end());
  const auto quality_of = [&](const std::array<Index, 4>& v, double above) {
    const double quality = new_quality(v, above);
    if (quality < 0) return quality;
    const bool allowed = std::ranges::all_of(cell_shapes::corner_pairs, [&](const EdgePlaces& edge) {
      const Index a = std::min(v[edge[0]], v[edge[1]]), b = std::max(v[edge[0]], v[edge[1]]);
      return std::ranges::binary_search(edges, std::array<Index, 2>{a, b}) ||
             rule_.allows_edge(a, b, squared_distance(mesh_.points[a], mesh_.points[b]), longest);
    });
    return allowed ? quality : -1;
  };
  const double above = change.kind == Change::Kind::none ? worst : std::max(worst, change.quality);
  const auto tets = fill_polyhedron(*hull, above, quality_of, most_fillings);
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

}  // namespace collarmesh::improvement
