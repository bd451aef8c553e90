#include "refine/gap_explorer.h"

#include <algorithm>
#include <unordered_map>
#include <utility>

#include "common/edge_key.h"
#include "common/segments.h"

namespace collarmesh {

void GapExplorer::find_borders() {
  std::vector<Index> vertex_at(points_.size(), none);
  std::unordered_map<std::uint64_t, Index> curve_of;
  for (Index v = 0; v < plc_.vertices.size(); ++v) vertex_at[plc_.vertices[v].point] = v;
  for (Index c = 0; c < plc_.curves.size(); ++c)
    visit_segments(plc_.curves[c], [&](Index a, Index b) { curve_of[edge_key(a, b)] = c; });
  const TriangleHierarchy& hierarchy = nodes_.hierarchy();
  border_of_.assign(hierarchy.triangle_count(), none);
  std::vector<Index> patch_of(hierarchy.triangle_count(), none);
  for (Index element = 0; element < border_of_.size(); ++element) {
    const auto& e = hierarchy.points(element);
    Border border;
    bool any = false;
    for (unsigned k = 0; k < 3; ++k) {
      border.vertices[k] = vertex_at[e[k]];
      const auto curve = curve_of.find(edge_key(e[k], e[(k + 1) % 3]));
      if (curve != curve_of.end()) border.curves[k] = curve->second;
      any = any || border.vertices[k] != none || border.curves[k] != none;
    }
    if (any) {
      border_of_[element] = static_cast<Index>(borders_.size());
      borders_.push_back(border);
    } else if (element < plc_.triangles.size()) {
      patch_of[element] = plc_.triangles[element].patch;
    }
  }
  patch_below_ = hierarchy.common_labels(patch_of);
  interviewed_.assign(patch_below_.size(), 0);
}

double GapExplorer::at_vertex(Index vertex, double bound) {
  return explore({0, vertex}, points_[plc_.vertices[vertex].point], bound);
}

double GapExplorer::on_curve(Index curve, const Point& p, double bound) {
  return explore({1, curve}, p, bound);
}

double GapExplorer::explore(const Feature& at, const Point& x, double bound) {
  ++queries_;
  near_ = mesh_.nearest_vertex(x, near_);
  // The last witness is often still near.
  Witness& last = last_witness(at);
  double squared = bound * bound;
  if (last.points[0] != none) squared = std::min(squared, squared_distance_to(last.points, x));
  ++exploration_;
  mesh_.visit_ball(x, near_, squared, [&](Index vertex) {
    ++explored_;
    fresh_nodes_.clear();
    for (const Index node : nodes_.at(vertex))
      if (std::exchange(interviewed_[node], exploration_) != exploration_) fresh_nodes_.push_back(node);
    interview(fresh_nodes_, at, x, squared, [&](Index a, Index b, Index c) {
      const double d = squared_distance_to({a, b, c}, x);
      if (d >= squared) return;
      squared = d;
      last.points = {a, b, c};
    });
  });
  return std::sqrt(squared);
}

bool GapExplorer::isolated(const Feature& vertex_or_curve, Index cell, std::span<const CollarBall> except) {
  mesh_.adjacent_vertices(cell, adjacent_);
  Witness& last = last_witness(vertex_or_curve);
  if (last.points[0] != none && reaches_into(cell, last.points, except)) {
    last.cell = cell;
    return false;
  }
  double squared_bound = INFINITY;  // 0 as soon as a witness has been found
  interview(nodes_.at(cell), vertex_or_curve, mesh_.point(cell), squared_bound,
            [&](Index a, Index b, Index c) {
              if (squared_bound == 0 || !reaches_into(cell, {a, b, c}, except)) return;
              last = {{a, b, c}, cell};
              squared_bound = 0;
            });
  return squared_bound > 0;
}

bool GapExplorer::witness_remains(const Feature& vertex_or_curve, std::span<const CollarBall> except) {
  const Witness& last = last_witness(vertex_or_curve);
  if (last.cell == none) return false;
  mesh_.adjacent_vertices(last.cell, adjacent_);
  return reaches_into(last.cell, last.points, except);
}

bool GapExplorer::reaches_into(Index cell, const std::array<Index, 3>& points,
                               std::span<const CollarBall> except) {
  cut_to_cell(cell, points_[points[0]], points_[points[1]], points_[points[2]]);
  const auto holds_polygon = [&](const CollarBall& ball) {
    return std::ranges::all_of(polygon_, [&](const Point& p) {
      return squared_distance(p, ball.centre) < ball.radius * ball.radius;
    });
  };
  return !polygon_.empty() && std::ranges::none_of(except, holds_polygon);
}

// Cuts the triangle by the planes between the vertex and its neighbours, until nothing is left or all planes
// are done.
void GapExplorer::cut_to_cell(Index vertex, const Point& a, const Point& b, const Point& c) {
  const Point& u = mesh_.point(vertex);
  polygon_ = {a, b, c};
  for (const Index neighbour : adjacent_) {
    const Vector n = mesh_.point(neighbour) - u;
    const double half = 0.5 * squared_norm(n);
    clipped_.clear();
    for (std::size_t i = 0; i < polygon_.size(); ++i) {
      const Point &p = polygon_[i], &q = polygon_[(i + 1) % polygon_.size()];
      const double beyond_p = dot(p - u, n) - half, beyond_q = dot(q - u, n) - half;
      if (beyond_p < 0) clipped_.push_back(p);
      if ((beyond_p < 0) != (beyond_q < 0))
        clipped_.push_back(p + beyond_p / (beyond_p - beyond_q) * (q - p));
    }
    polygon_.swap(clipped_);
    if (polygon_.empty()) return;
  }
}

template <class Found>
void GapExplorer::interview(std::span<const Index> nodes, const Feature& at, const Point& x,
                            const double& squared_bound, const Found& witness) {
  const auto counts = [&](const Feature& feature) { return !contains(plc_, feature, at); };
  const auto contains_all = [&](Index node) {
    return patch_below_[node] != none && !counts({2, patch_below_[node]});
  };
  nodes_.hierarchy().visit_near(nodes, x, squared_bound, contains_all, [&](Index element) {
    ++interviews_;
    const auto& e = nodes_.hierarchy().points(element);
    // The border of a patch is no nearer than the patch, so triangles of patches that count need no test of
    // their border. An element without a border always counts here, because the search skips the others.
    const bool is_triangle = element < plc_.triangles.size();
    if (border_of_[element] == none || (is_triangle && counts({2, plc_.triangles[element].patch})))
      return witness(e[0], e[1], e[2]);
    const Border& border = borders_[border_of_[element]];
    for (unsigned k = 0; k < 3; ++k) {
      const Index curve = border.curves[k], vertex = border.vertices[k], next = e[(k + 1) % 3];
      if (curve != none && counts({1, curve})) witness(e[k], next, next);
      if (vertex != none && counts({0, vertex})) witness(e[k], e[k], e[k]);
    }
  });
}

}  // namespace collarmesh
