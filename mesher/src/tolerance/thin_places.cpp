#include "tolerance/thin_places.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "common/parallel_for.h"
#include "tolerance/thickness.h"

namespace collarmesh {

double squares_in_thin_places(const Plc& plc, double thinner_than) {
  constexpr double least_facing = 0.9;  // sides more than 26 degrees from parallel make no thin place
  const double reach = 1.01 * thinner_than;
  const Thickness thickness(plc);
  std::vector<double> squares(plc.triangles.size(), 0);
  parallel_for_ranges(squares.size(), 256, [&](std::size_t begin, std::size_t end) {
    Thickness::Crossings crossings;
    for (auto t = static_cast<Index>(begin); t < end; ++t) {
      if (!plc.patches[plc.triangles[t].patch].planar) continue;
      double thin = INFINITY;
      for (unsigned side = 0; side < 2; ++side) {
        const Thickness::Opposite first = thickness.at(t, side, crossings, reach).first;
        if (first.triangle != none && first.facing >= least_facing) thin = std::min(thin, first.distance);
      }
      if (!(thin < thinner_than)) continue;
      const auto& [a, b, c] = plc.triangles[t].points;
      squares[t] =
          0.5 * norm(cross(plc.points[b] - plc.points[a], plc.points[c] - plc.points[a])) / (thin * thin);
    }
  });
  return std::accumulate(squares.begin(), squares.end(), 0.0);
}

}  // namespace collarmesh
