#include "refine/aspect_ratios.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace collarmesh {

AspectRatios aspect_ratios(const RefinedMesh& mesh, const std::function<bool(Index cell)>& counts) {
  std::vector<double> squared_radius(mesh.vertex_count(), 0), squared_edge(mesh.vertex_count(), INFINITY);
  for (Index cell = 0; cell < mesh.cell_capacity(); ++cell) {
    if (!mesh.alive(cell)) continue;
    const auto& v = mesh.corners(cell);
    const bool all_count = counts(cell);
    const double radius = all_count ? mesh.squared_radius(cell) : INFINITY;
    for (unsigned i = 0; i < 4; ++i) {
      squared_radius[v[i]] = std::max(squared_radius[v[i]], radius);
      for (unsigned j = i + 1; j < 4; ++j) {
        const double length = squared_distance(mesh.point(v[i]), mesh.point(v[j]));
        squared_edge[v[i]] = std::min(squared_edge[v[i]], length);
        squared_edge[v[j]] = std::min(squared_edge[v[j]], length);
      }
    }
  }
  AspectRatios ratios;
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    if (squared_radius[v] == INFINITY) continue;
    const double ratio = 2 * std::sqrt(squared_radius[v] / squared_edge[v]);
    ratios.smallest = ratios.smallest == 0 ? ratio : std::min(ratios.smallest, ratio);
    ratios.largest = std::max(ratios.largest, ratio);
  }
  return ratios;
}

}  // namespace collarmesh
