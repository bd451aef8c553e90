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
    for (const Index a : v) {
      squared_radius[a] = std::max(squared_radius[a], all_count ? mesh.squared_radius(cell) : INFINITY);
      for (const Index b : v)
        if (b != a)
          squared_edge[a] = std::min(squared_edge[a], squared_distance(mesh.point(a), mesh.point(b)));
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
