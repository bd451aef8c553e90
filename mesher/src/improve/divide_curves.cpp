#include "improve/improve_edited.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "remesh/operations.h"

namespace collarmesh::remeshing::improvement {

namespace {

constexpr double much_longer = 1.5;
constexpr double least_divided = 1e-4;  // least quality of new tets

/// Returns the longest of the tet's edges on curves if it is much longer than the tet's shortest edge; else
/// nothing.
std::optional<std::array<Index, 2>> edge_to_divide(const TetComplex& complex, Index tet) {
  const auto& v = complex[tet].corners;
  const auto p = complex.corners(tet);
  double shortest = INFINITY, longest = 0;
  std::optional<std::array<Index, 2>> edge;
  for (unsigned i = 0; i < 4; ++i)
    for (unsigned j = 0; j < i; ++j) {
      const double length = distance(p[i], p[j]);
      shortest = std::min(shortest, length);
      if (length <= longest || !complex.on_curve(v[i], v[j])) continue;
      longest = length;
      edge = {v[i], v[j]};
    }
  return longest > much_longer * shortest ? edge : std::nullopt;
}

}  // namespace

std::size_t divide_curves_at_poor_tets(EditableMesh& edited, const Bounds& bounds) {
  const TetComplex& complex = edited.complex;
  const ThinRule rule(edited.tet_bounds(bounds));
  const RadiusEdgeBound ratio(bounds.radius_edge);
  Operations operations(edited, rule);
  std::size_t divided = 0;
  for (Index t = 0, tets = complex.size(); t < tets; ++t) {
    if (!complex[t].alive || ratio.holds(complex.corners(t)) ||
        rule.quality(complex.corners(t), complex[t].corners) >= 1)
      continue;
    const auto edge = edge_to_divide(complex, t);
    if (!edge || edited.is_fixed((*edge)[0]) || edited.is_fixed((*edge)[1])) continue;
    Change change;
    operations.divide_edge((*edge)[0], (*edge)[1], 0.5, least_divided, change);
    if (change.is_none()) continue;
    edited.apply(std::move(change));
    ++divided;
  }
  return divided;
}

}  // namespace collarmesh::remeshing::improvement
