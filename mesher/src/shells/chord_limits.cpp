#include "shells/chord_limits.h"

#include <algorithm>

#include "shells/narrow_places.h"

namespace collarmesh::shells {

ChordLimits::ChordLimits(const SurfaceComplex& complex, const Plc& plc, const std::vector<Index>& point_of,
                         const SurfaceTolerance& tolerance)
    : tolerance_(tolerance), narrow_(plc.points.size()) {
  constexpr double share = 0.1, least = 1e-3;  // `share` is relative to the distance between the curves,
                                               // `least` to the tolerance
  for_narrow_triangles(complex, [&](const NarrowTriangle& narrow) {
    const auto& triangle = complex.triangles[narrow.triangle];
    for (const Index v : triangle.corners) {
      const Index p = point_of[v];
      narrow_[p].emplace_back(triangle.patch, std::max(share * narrow.width, least * tolerance_.at_point(p)));
    }
  });
}

double ChordLimits::at_point(Index point, std::span<const Index> without) const {
  double limit = tolerance_.at_point(point);
  for (const auto& [patch, most] : narrow_[point])
    if (std::find(without.begin(), without.end(), patch) == without.end()) limit = std::min(limit, most);
  return limit;
}

}  // namespace collarmesh::shells
