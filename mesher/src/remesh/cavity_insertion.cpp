// Inserts a vertex inside a region, into a cavity that grows around a tet.
#include <algorithm>

#include "common/cell_shapes.h"
#include "common/contains.h"
#include "remesh/operations.h"

namespace collarmesh::remeshing {

namespace {

constexpr std::size_t most_tets = 24;

}  // namespace

void Operations::insert_in_cavity(Index tet, double least, Change& change) {
  grow_and_insert({tet}, least, change);
  for (const auto& [i, j] : cell_shapes::corner_pairs) {
    const Index a = complex_[tet].corners[i], b = complex_[tet].corners[j];
    if (complex_.on_faces(a, b) || complex_.on_curve(a, b)) continue;
    complex_.ring(tet, a, b, ring_);
    if (ring_.closed && ring_.tets.size() <= most_tets) grow_and_insert(ring_.tets, least, change);
  }
}

// Extends a cavity by the tet behind the hull face of the worst new tet, as long as that raises the quality
// of the worst new tet. Then proposes a vertex in the cavity, if all new tets are better than `least` and
// `change`.
void Operations::grow_and_insert(std::vector<Index> cavity, double least, Change& change) {
  if (!find_cone_of_cavity(cavity)) return;
  auto [place, quality] = best_place(centre_of_hull(), none, everywhere, -1);
  Cone best = cone_;
  while (quality > 0 && cavity.size() < most_tets) {
    const Index next = beyond_worst_of_hull(place);
    if (next == none) break;
    cavity.push_back(next);
    if (!find_cone_of_cavity(cavity)) break;
    const auto [other, as_good] = best_place(place, none, everywhere, -1);
    if (as_good <= quality) break;
    place = other;
    quality = as_good;
    best = cone_;
  }
  if (quality <= std::max(least, change.quality)) return;
  cone_ = std::move(best);
  fill_insertion(place, quality, {}, change);
}

// Finds the cone of a cavity. Returns false if a vertex, a mesh face or an edge on a curve lies inside, or if
// one of the tets has to stay.
bool Operations::find_cone_of_cavity(const std::vector<Index>& cavity) {
  cone_.clear();
  cone_.tets = cavity;
  for (const Index t : cavity) {
    const auto& tet = complex_[t];
    if (untouchable(tet)) return false;
    for (unsigned corner = 0; corner < 4; ++corner) {
      if (tet.neighbours[corner] == none || !contains(cavity, tet.neighbours[corner])) {
        cone_.hull.push_back(side_corners(tet.corners, corner));
        cone_.hull_tet.push_back(t);
      } else if (tet.faces[corner] != none) {
        return false;
      }
    }
  }
  const auto on_hull = [&](Index a, Index b) {
    return std::ranges::any_of(cone_.hull,
                               [&](const auto& face) { return contains(face, a) && contains(face, b); });
  };
  return std::ranges::all_of(cavity, [&](Index t) {
    const auto& v = complex_[t].corners;
    return std::ranges::all_of(v, [&](Index w) { return on_hull(w, w); }) &&
           std::all_of(cell_shapes::corner_pairs.begin(), cell_shapes::corner_pairs.end(),
                       [&](const auto& edge) {
                         const Index a = v[edge[0]], b = v[edge[1]];
                         return !complex_.on_curve(a, b) || on_hull(a, b);
                       });
  });
}

Point Operations::centre_of_hull() const {
  Vector sum{0, 0, 0};
  const Point& first = mesh_.points[cone_.hull.front()[0]];
  for (const auto& face : cone_.hull)
    for (const Index v : face) sum = sum + (mesh_.points[v] - first);
  return first + sum / (3.0 * static_cast<double>(cone_.hull.size()));
}

// Returns the tet outside the cavity at the hull face that makes the worst tet with this apex; none if that
// hull face is a mesh face.
Index Operations::beyond_worst_of_hull(const Point& apex) const {
  double worst = INFINITY;
  std::size_t at = 0;
  for (std::size_t i = 0; i < cone_.hull.size(); ++i) {
    const auto& [b, c, d] = cone_.hull[i];
    const std::array<Index, 4> corners{none, b, c, d};
    const double quality = rule_.quality(with_apex(apex, corners), corners);
    if (quality >= worst) continue;
    worst = quality;
    at = i;
  }
  const auto& tet = complex_[cone_.hull_tet[at]];
  for (unsigned corner = 0; corner < 4; ++corner)
    if (!contains(cone_.hull[at], tet.corners[corner]))
      return tet.faces[corner] == none ? tet.neighbours[corner] : none;
  return none;
}

}  // namespace collarmesh::remeshing
