#pragma once

#include <algorithm>
#include <cstddef>
#include <map>
#include <utility>
#include <vector>

#include "repair/snap_state.h"

namespace collarmesh::repairing {

/// The points that edges and triangles get in one round. Cuts the edges and triangles at these points.
class SnapCuts {
 public:
  struct OnEdge {
    double parameter;  ///< position on the edge: 0 at the end with the smaller index, 1 at the other end
    Index point;
  };

  /// Keeps a reference to the state.
  explicit SnapCuts(SnapState& state) : state_(state) {}

  void clear();

  /// Adds a point to the points that an edge gets. `moved`: its distance from the edge, for the report.
  void add(const Edge& edge, const OnEdge& point, double moved);
  /// If a point is within the limit of a triangle's plane and its projection onto the plane is inside the
  /// triangle, adds it to the points that the triangle gets and returns true. Otherwise returns false.
  bool add_if_inside(Index triangle, Index point);
  /// Records that an edge of another triangle comes near this triangle: the edge's pieces there become edges
  /// between this triangle's pieces, too.
  void add_along(Index triangle, const Edge& edge) { along_[triangle].push_back(edge); }

  bool empty() const { return on_edge_.empty() && inside_.empty(); }
  bool has_edges() const { return !on_edge_.empty(); }
  std::size_t triangles_with_points() const { return inside_.size(); }
  /// Returns the points that an edge gets; null if there are none.
  const std::vector<OnEdge>* on(const Edge& edge) const;
  std::size_t points_inside(Index triangle) const;
  /// Calls visit(edge) for each edge that gets points.
  template <class Visit>
  void for_each_edge(const Visit& visit) const {
    for (const auto& [edge, points] : on_edge_) visit(edge);
  }
  /// Calls visit(t, edges) for each triangle and the edges that come near it, each once.
  template <class Visit>
  void for_each_along(const Visit& visit) {
    for (auto& [t, edges] : along_) {
      std::sort(edges.begin(), edges.end());
      edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
      visit(t, std::as_const(edges));
    }
  }
  /// Returns the number of triangles that cutting the edges would add.
  std::size_t pieces() const;
  /// Returns the points of an edge from a to b, both included.
  std::vector<Index> chain(Index a, Index b) const;

  /// Cuts the triangles and segments.
  void apply();

 private:
  void cut_segments();
  void cut(Index t, const facets::Corners& corners, const facets::Origin& origin);
  std::vector<Edge> constraints(Index t, const facets::Corners& corners) const;
  void insert(Index p, std::vector<facets::Corners>& pieces) const;
  void add_cut(const facets::Corners& triangle, const facets::Origin& origin);
  const Point& at(Index p) const { return state_.at(p); }

  SnapState& state_;
  std::map<Edge, std::vector<OnEdge>> on_edge_;
  std::map<Index, std::vector<Index>> inside_;  // by triangle: points inside it
  std::map<Index, std::vector<Edge>> along_;    // by triangle: edges that come near it
};

}  // namespace collarmesh::repairing
