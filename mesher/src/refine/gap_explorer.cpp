#include "refine/gap_explorer.h"

#include <algorithm>

#include "refine/elements.h"

namespace collarmesh {

namespace {

std::uint64_t segment_key(Index a, Index b) { return std::uint64_t{std::min(a, b)} << 32U | std::max(a, b); }

}  // namespace

GapExplorer::GapExplorer(const Domain& domain, const RefinedMesh& mesh, const SurfaceNodes& nodes)
    : plc_(domain.plc),
      points_(domain.points),
      mesh_(mesh),
      nodes_(nodes),
      vertex_at_(domain.points.size(), none) {
  for (Index v = 0; v < plc_.vertices.size(); ++v) vertex_at_[plc_.vertices[v].point] = v;
  for (Index c = 0; c < plc_.curves.size(); ++c)
    visit_segments(plc_.curves[c], [&](Index a, Index b) { curve_of_[segment_key(a, b)] = c; });
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
  double squared = bound * bound;
  interviewed_.clear();
  mesh_.visit_ball(x, near_, squared, [&](Index vertex) {
    ++explored_;
    fresh_nodes_.clear();
    for (const Index node : nodes_.at(vertex))
      if (interviewed_.insert(node).second) fresh_nodes_.push_back(node);
    interview(fresh_nodes_, at, x, squared, [&](const Point& a, const Point& b, const Point& c) {
      squared = std::min(squared, squared_distance_to_triangle(x, a, b, c));
    });
  });
  return std::sqrt(squared);
}

bool GapExplorer::isolated(const Feature& vertex_or_curve, Index cell, std::span<const CollarBall> except) {
  mesh_.adjacent_vertices(cell, adjacent_);
  const auto holds_polygon = [&](const CollarBall& ball) {
    return std::all_of(polygon_.begin(), polygon_.end(), [&](const Point& p) {
      return squared_distance(p, ball.centre) < ball.radius * ball.radius;
    });
  };
  double squared_bound = INFINITY;  // 0 when a witness has been found
  interview(nodes_.at(cell), vertex_or_curve, mesh_.point(cell), squared_bound,
            [&](const Point& a, const Point& b, const Point& c) {
              if (squared_bound == 0) return;
              cut_to_cell(cell, a, b, c);
              if (!polygon_.empty() && std::none_of(except.begin(), except.end(), holds_polygon))
                squared_bound = 0;
            });
  return squared_bound > 0;
}

// By the planes between the vertex and its neighbours, as long as anything is left.
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

template <class Witness>
void GapExplorer::interview(std::span<const Index> nodes, const Feature& at, const Point& x,
                            const double& squared_bound, const Witness& witness) {
  const auto counts = [&](const Feature& feature) { return !contains(plc_, feature, at); };
  nodes_.hierarchy().visit_near(nodes, x, squared_bound, [&](Index element) {
    const auto& e = nodes_.hierarchy().points(element);
    // What bounds a patch is no nearer than the patch.
    if (element < plc_.triangles.size() && counts({2, plc_.triangles[element].patch}))
      return witness(points_[e[0]], points_[e[1]], points_[e[2]]);
    for (unsigned k = 0; k < 3; ++k) {
      const Index i = e[k], j = e[(k + 1) % 3];
      const auto curve = curve_of_.find(segment_key(i, j));
      if (curve != curve_of_.end() && counts({1, curve->second})) witness(points_[i], points_[j], points_[j]);
      if (vertex_at_[i] != none && counts({0, vertex_at_[i]})) witness(points_[i], points_[i], points_[i]);
    }
  });
}

}  // namespace collarmesh
