#pragma once

#include <vector>

#include "delaunay/triangulation.h"

namespace collarmesh {

/// A walk from one Voronoi cell of the mesh to the next.
class VoronoiWalk {
 public:
  /// Keeps the mesh by reference.
  explicit VoronoiWalk(Triangulation& mesh) : mesh_(mesh) {}

  /// Returns the vertex whose cell contains p. Walks from `from` to a nearer neighbour as long as there is
  /// one.
  Index nearest(const Point& p, Index from) {
    double best = squared_distance(p, mesh_.point(from));
    for (;;) {
      mesh_.adjacent_vertices(from, adjacent_);
      Index next = from;
      for (const Index v : adjacent_) {
        const double d = squared_distance(p, mesh_.point(v));
        if (d >= best) continue;
        best = d;
        next = v;
      }
      if (next == from) return from;
      from = next;
    }
  }

  /// Visits the vertices whose cells meet the ball of this squared radius around x, and few others, breadth
  /// first from `nearest`, the vertex whose cell contains x. The visitor may make the ball smaller:
  /// `squared_radius` is read anew for every vertex.
  template <class Visit>
  void visit_ball(const Point& x, Index nearest, const double& squared_radius, const Visit& visit) {
    found_.assign(1, nearest);
    marks_.resize(mesh_.vertex_count(), 0);
    marks_[nearest] = ++mark_;
    const double shortest = squared_distance(x, mesh_.point(nearest));
    for (std::size_t i = 0; i < found_.size(); ++i) {
      const Index vertex = found_[i];
      // The cell lies beyond the bisector plane between its vertex and the vertex nearest to x.
      const double across = distance(mesh_.point(vertex), mesh_.point(nearest));
      const double beyond =
          i == 0 ? 0 : (squared_distance(x, mesh_.point(vertex)) - shortest) / (2 * across) * (1 - 1e-9);
      if (beyond * beyond >= squared_radius) continue;
      visit(vertex);
      mesh_.adjacent_vertices(vertex, adjacent_);
      for (const Index v : adjacent_) {
        if (marks_[v] == mark_) continue;
        marks_[v] = mark_;
        found_.push_back(v);
      }
    }
  }

 private:
  Triangulation& mesh_;
  std::vector<Index> found_, adjacent_;
  std::vector<std::uint32_t> marks_;
  std::uint32_t mark_ = 0;
};

}  // namespace collarmesh
