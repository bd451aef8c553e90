#pragma once

#include <cstddef>
#include <set>
#include <span>
#include <vector>

#include "repair/snap_cuts.h"
#include "repair/snap_state.h"

namespace collarmesh::repairing {

/// Factor on the limit that covers rounding in distances from planes and edges.
inline constexpr double beyond_plane = 1 + 1e-9;

/// The step of snapping that inserts corners into edges near them, the longest edges first.
class CornerSnapper {
 public:
  enum class Outcome { nothing_near, snapped, too_many };

  /// Keeps references to both arguments.
  CornerSnapper(SnapState& state, SnapCuts& cuts) : state_(state), cuts_(cuts) {}

  /// Cuts edges near corners, unless that makes more than `most_triangles` new triangles. Compares a corner
  /// with an edge only if at least one of the two belongs to a triangle not examined yet.
  Outcome snap(std::size_t most_triangles);

  /// Allows each edge to be cut once more even if the new edges are not shorter than it.
  void allow_cuts() { cut_before_.clear(); }

 private:
  // A corner, and an edge near it that does not end there.
  struct NearEdge {
    double length, distance;  // length of the edge; distance of the corner from it
    Edge edge;
    SnapCuts::OnEdge corner;

    bool operator<(const NearEdge& other) const;
  };

  std::vector<NearEdge> near_edges();
  void choose(const std::vector<NearEdge>& found);
  void find_near_edge(Index p, const Edge& edge, std::vector<NearEdge>& found) const;
  bool may_cut(const NearEdge& near, std::span<const Index> sides);
  bool has_room(const NearEdge& near) const;
  const Point& at(Index p) const { return state_.at(p); }

  SnapState& state_;
  SnapCuts& cuts_;
  std::set<Edge> cut_before_;
};

}  // namespace collarmesh::repairing
