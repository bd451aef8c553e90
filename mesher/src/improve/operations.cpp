#include "improve/operations.h"

#include <algorithm>

#include "improve/shape.h"

namespace collarmesh::improvement {

double Operations::quality(Index tet) const { return shape_quality(complex_.corners(tet)); }

// Not above `above` means worthless, whatever the value.
double Operations::new_quality(const std::array<Index, 4>& v, double above) const {
  const auto& points = complex_.mesh().points;
  const Corners p{points[v[0]], points[v[1]], points[v[2]], points[v[3]]};
  const double quality = shape_quality(p);
  if (quality <= above) return -1;
  const Circumsphere sphere = circumsphere(p);
  return sphere.squared_radius <= squared_radius_edge_ * sphere.shortest_squared_edge ? quality : -1;
}

const std::vector<Index>& Operations::apply(const Change& change) {
  const auto& replacement = change.replacement;
  if (change.kind == Change::Kind::move) {
    complex_.star(change.vertex, changed_);
    complex_.mesh().points[change.vertex] = change.place;
    if (complex_.mesh().features[change.vertex].dimension == 1) curves_.moved(change.vertex, change.way);
    surfaces_.replaced(replacement.old_faces, replacement.old_faces);
    return changed_;
  }
  if (change.kind == Change::Kind::insertion) complex_.add_vertex(change.place, change.feature);
  if (change.kind == Change::Kind::contraction && complex_.mesh().features[change.vertex].dimension == 1) {
    const auto [before, after] = curves_.neighbours(change.vertex);
    complex_.join_curve_edges(before, change.vertex, after);
    curves_.skipped(change.vertex);
  }
  const auto created = complex_.replace(replacement);
  changed_.assign(created.begin(), created.end());
  surfaces_.replaced(replacement.old_faces, complex_.created_faces());
  return changed_;
}

}  // namespace collarmesh::improvement
