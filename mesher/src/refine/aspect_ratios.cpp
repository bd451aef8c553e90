#include "refine/aspect_ratios.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <vector>

#include "common/parallel_for.h"

namespace collarmesh {

namespace {

/// Replaces the value at `place` by `value` if comes_first(value, old value) is true. Several threads may
/// call it at once.
template <class ComesFirst>
void replace_if(const ComesFirst& comes_first, double& place, double value) {
  const std::atomic_ref<double> shared(place);
  double found = shared.load(std::memory_order_relaxed);
  while (comes_first(value, found) &&
         !shared.compare_exchange_weak(found, value, std::memory_order_relaxed)) {
  }
}

}  // namespace

AspectRatios aspect_ratios(const RefinedMesh& mesh, const std::function<bool(Index cell)>& counts) {
  std::vector<double> squared_radius(mesh.vertex_count(), 0), squared_edge(mesh.vertex_count(), INFINITY);
  const auto see_cell = [&](Index cell) {
    const auto& v = mesh.corners(cell);
    const double radius = counts(cell) ? mesh.squared_radius(cell) : INFINITY;
    for (unsigned i = 0; i < 4; ++i) {
      replace_if(std::greater<double>(), squared_radius[v[i]], radius);
      for (unsigned j = i + 1; j < 4; ++j) {
        const double length = squared_distance(mesh.point(v[i]), mesh.point(v[j]));
        replace_if(std::less<double>(), squared_edge[v[i]], length);
        replace_if(std::less<double>(), squared_edge[v[j]], length);
      }
    }
  };
  parallel_for_in_chunks(mesh.cell_capacity(), [&](std::size_t cell) {
    if (mesh.alive(static_cast<Index>(cell))) see_cell(static_cast<Index>(cell));
  });
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
