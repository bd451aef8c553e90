#include "tolerance/thin_shells.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "common/parallel_for.h"
#include "tolerance/curvature.h"
#include "tolerance/thickness.h"

namespace collarmesh {

namespace {

// Shells matter if covering them takes more than `least_squares` squares whose sides are as long as the shell
// is thick, and more than `least_ratio` times as many squares as rectangles whose sides are chords.
constexpr double least_squares = 20'000, least_ratio = 30;

/// Returns the distance to the opposite side of the wall or gap; infinite if there is none within the reach.
double thickness_at(const Thickness& thickness, Index triangle, double reach,
                    Thickness::Crossings& crossings) {
  double thin = INFINITY;
  for (unsigned side = 0; side < 2; ++side) {
    const auto apart = thickness.at(triangle, side, crossings, reach).apart;
    if (apart.triangle != none) thin = std::min(thin, apart.distance);
  }
  return thin;
}

}  // namespace

bool has_thin_shells(const Plc& plc, const SurfaceTolerance& tolerance, double size) {
  struct Squares {
    double of_thickness = 0, of_chords = 0;
  };
  struct Chords {
    double shorter = 0, longer = 0;
  };
  std::vector<Chords> chords(plc.triangles.size());
  for (const Plc::Patch& patch : plc.patches) {
    if (patch.planar) continue;
    const std::vector<Curvature> curvature = curvatures(plc, patch);
    for (Index i = 0; i < patch.triangle_count; ++i) {
      const Index t = patch.first_triangle + i;
      const double largest = curvature[i].largest, other = std::fabs(largest - std::fabs(curvature[i].sum));
      const auto chord = [&](double of) {
        return std::min(size, std::sqrt(8 * tolerance.at_triangle(t) / of));
      };
      chords[t] = {chord(largest), chord(std::min(largest, other))};
    }
  }
  const Thickness thickness(plc);
  std::vector<Squares> squares(plc.triangles.size());
  parallel_for_ranges(squares.size(), 256, [&](std::size_t first, std::size_t last) {
    Thickness::Crossings crossings;
    for (auto t = static_cast<Index>(first); t < last; ++t) {
      if (chords[t].shorter == 0) continue;
      const double thin = thickness_at(thickness, t, 1.01 * chords[t].shorter, crossings);
      if (!(thin < chords[t].shorter)) continue;
      const auto& [a, b, c] = plc.triangles[t].points;
      const double area = 0.5 * norm(cross(plc.points[b] - plc.points[a], plc.points[c] - plc.points[a]));
      squares[t] = {area / (thin * thin), area / (chords[t].shorter * chords[t].longer)};
    }
  });
  const Squares all =
      std::accumulate(squares.begin(), squares.end(), Squares(), [](const Squares& x, const Squares& y) {
        return Squares{x.of_thickness + y.of_thickness, x.of_chords + y.of_chords};
      });
  return all.of_thickness > least_squares && all.of_thickness > least_ratio * all.of_chords;
}

}  // namespace collarmesh
