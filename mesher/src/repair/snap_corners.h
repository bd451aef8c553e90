#pragma once

#include <cstddef>
#include <set>
#include <span>
#include <vector>

#include "repair/snap_cuts.h"
#include "repair/snap_state.h"

namespace collarmesh::repairing {

/// How far beyond the limit an edge or a corner may be from a plane or an edge by rounding alone.
inline constexpr double beyond_plane = 1 + 1e-9;

/// Edges get the corners near them, the longest first.
class CornerSnapper {
 public:
  enum class Outcome { nothing_near, snapped, too_many };

  /// Keeps both by reference.
  CornerSnapper(SnapState& state, SnapCuts& cuts) : state_(state), cuts_(cuts) {}

  /// Cuts edges of triangles that were not looked at, unless that makes more than so many triangles.
  Outcome snap(std::size_t most_triangles);

  /// Each edge may be cut once more, however long its pieces are.
  void allow_cuts() { cut_before_.clear(); }

 private:
  // A corner near an edge that it is no end of.
  struct NearEdge {
    double length, distance;  // of the edge, and to it
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
