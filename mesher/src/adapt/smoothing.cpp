#include "adapt/smoothing.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstdint>
#include <vector>

#include "coarsen/coarsening_rule.h"
#include "common/cell_shapes.h"
#include "common/cells_at_vertices.h"
#include "common/parallel_for.h"
#include "remesh/cell_bounds.h"

namespace collarmesh::remeshing::adapting {

namespace {

constexpr unsigned most_sweeps = 2;
// A sweep that moves a smaller share of the vertices is the last one.
constexpr double least_share_moved = 0.01;
// Share by which a move must raise the sum of the mean ratios.
constexpr double least_gain = 1e-3;
// Shares of the way to the new place that a move tries, one after the other.
constexpr std::array steps{1.0, 0.5};
constexpr std::size_t vertices_at_once = 64;
constexpr unsigned most_colours = 64;

/// Returns the mean ratio to the power of 3/2: 1 for a regular tet, not positive for an inverted one.
double mean_ratio(const Corners& p) {
  constexpr double of_regular = 20.784609690826528;  // 12 sqrt(3): (sum of squares)^(3/2) / (6 volume)
  double squares = 0;
  for (const auto& [i, j] : cell_shapes::corner_pairs) squares += squared_distance(p[i], p[j]);
  return of_regular * six_volume(p[0], p[1], p[2], p[3]) / (squares * std::sqrt(squares));
}

class Smoothing {
 public:
  Smoothing(TetMesh& mesh, const Plc& plc, const Bounds& bounds, const Metric& metric)
      : mesh_(mesh),
        metric_(metric),
        bounds_{ThinShape(plc, mesh, bounds.thin_angle, bounds.reserve,
                          forced_edges_of(plc, mesh, bounds.lower_where_forced)),
                CellBounds(plc, mesh, bounds)},
        rule_(bounds_, bounds.radius_edge, metric_),
        star_(mesh.tets, mesh.points.size()) {
    find_independent_sets();
  }

  std::size_t run(const Execution& execution) {
    std::size_t all = 0;
    for (unsigned sweep = 0; sweep < most_sweeps; ++sweep) {
      std::atomic<std::size_t> moved = 0;
      for (const std::vector<Index>& vertices : independent_) {
        if (execution.cancelled()) return all;
        parallel_for_ranges(vertices.size(), vertices_at_once, [&](std::size_t first, std::size_t last) {
          std::size_t here = 0;
          for (std::size_t i = first; i < last; ++i) here += move(vertices[i]) ? 1 : 0;
          moved += here;
        });
      }
      all += moved;
      if (static_cast<double>(moved) < least_share_moved * static_cast<double>(mesh_.points.size())) break;
    }
    return all;
  }

 private:
  /// Sorts the vertices that may move into sets without edges between their members.
  void find_independent_sets() {
    std::vector<std::uint8_t> colour(mesh_.points.size(), most_colours);
    independent_.resize(most_colours);
    for (Index v = 0; v < mesh_.points.size(); ++v) {
      if (mesh_.features[v].dimension != 3) continue;
      std::uint64_t used = 0;
      for (const Index t : star_[v])
        for (const Index w : mesh_.tets[t])
          if (colour[w] < most_colours) used |= std::uint64_t{1} << colour[w];
      if (~used == 0) continue;
      colour[v] = static_cast<std::uint8_t>(std::countr_one(used));
      independent_[colour[v]].push_back(v);
    }
    std::erase_if(independent_, [](const std::vector<Index>& set) { return set.empty(); });
  }

  bool move(Index vertex) {
    const Point before = mesh_.points[vertex];
    double sum = 0;
    const Vector way = centre_of_star(vertex, sum) - before;
    if (!(squared_norm(way) > 0)) return false;
    for (const double step : steps)
      if (is_better(vertex, before + step * way, (1 + least_gain) * sum)) {
        mesh_.points[vertex] = before + step * way;
        return true;
      }
    return false;
  }

  /// Returns the mean of the centres of the tets at a vertex, weighted by their volumes in the metric. Adds
  /// their mean ratios to `sum`.
  Point centre_of_star(Index vertex, double& sum) const {
    Vector weighted{};
    double weights = 0;
    for (const Index t : star_[vertex]) {
      const Corners p = corners(t);
      const double weight = metric_.volume(mesh_.tets[t], six_volume(p[0], p[1], p[2], p[3]));
      for (const Point& corner : p) weighted = weighted + 0.25 * weight * (corner - p[0]);
      weighted = weighted + weight * (p[0] - mesh_.points[vertex]);
      weights += weight;
      sum += mean_ratio(p);
    }
    return mesh_.points[vertex] + (1 / weights) * weighted;
  }

  bool is_better(Index vertex, const Point& place, double least_sum) const {
    double sum = 0;
    for (const Index t : star_[vertex]) {
      Corners p = corners(t);
      unsigned own = 0;
      for (unsigned i = 0; i < 4; ++i)
        if (mesh_.tets[t][i] == vertex) own = i;
      const Point before = p[own];
      p[own] = place;
      for (unsigned i = 0; i < 4; ++i)
        if (i != own && !rule_.allows_edge(vertex, mesh_.tets[t][i], p[i] - place, p[i] - before))
          return false;
      const double ratio = mean_ratio(p);
      if (!(ratio > 0)) return false;
      sum += ratio;
      if (!rule_.surely_exceeds(1, p, mesh_.tets[t]) && !(rule_.quality(p, mesh_.tets[t]) >= 1)) return false;
    }
    return sum > least_sum;
  }

  Corners corners(Index tet) const {
    const auto& v = mesh_.tets[tet];
    return {mesh_.points[v[0]], mesh_.points[v[1]], mesh_.points[v[2]], mesh_.points[v[3]]};
  }

  TetMesh& mesh_;
  const Metric& metric_;
  TetBounds bounds_;
  coarsening::CoarseningRule rule_;
  CellsAtVertices star_;
  std::vector<std::vector<Index>> independent_;  // vertices that may move at the same time
};

}  // namespace

std::size_t smooth(TetMesh& mesh, const Plc& plc, const Bounds& bounds, const Metric& metric,
                   const Execution& execution) {
  return Smoothing(mesh, plc, bounds, metric).run(execution);
}

}  // namespace collarmesh::remeshing::adapting
