#include "remesh/orientations.h"

#include <algorithm>
#include <array>
#include <vector>

#include "delaunay/predicates.h"

namespace collarmesh::remeshing {

bool stays_oriented(const improvement::TetComplex& complex, const improvement::Change& change) {
  using improvement::Change;
  const bool moves = change.kind == Change::Kind::move, inserts = change.kind == Change::Kind::insertion;
  const Index placed = moves ? change.vertex : Change::inserted;
  const auto at = [&](Index v) {
    return (moves || inserts) && v == placed ? change.place : complex.mesh().points[v];
  };
  const auto is_positive = [&](const std::array<Index, 4>& v) {
    return predicates::orientation(at(v[0]), at(v[1]), at(v[2]), at(v[3])) > 0;
  };
  if (!moves)
    return std::ranges::all_of(change.replacement.created,
                               [&](const auto& tet) { return is_positive(tet.corners); });
  std::vector<Index> star;
  complex.star(change.vertex, star);
  return std::ranges::all_of(star, [&](Index t) { return is_positive(complex[t].corners); });
}

}  // namespace collarmesh::remeshing
