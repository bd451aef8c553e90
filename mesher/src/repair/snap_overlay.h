#pragma once

#include <cstddef>
#include <set>
#include <utility>

#include "repair/point_grid.h"
#include "repair/snap_cuts.h"
#include "repair/snap_state.h"

namespace collarmesh::repairing {

/// The step of snapping that overlays triangles which run along each other: each gets the corners and edges
/// of the other.
class Overlay {
 public:
  /// Keeps references to both arguments.
  Overlay(SnapState& state, SnapCuts& cuts)
      : state_(state), cuts_(cuts), crossing_points_(state.draft().points, state.limit()) {}

  /// Overlays the triangles not examined yet. Returns whether any were cut.
  bool run();

  /// Returns how many crossings of edges the last run found, plus how many triangles got points inside.
  std::size_t count() const { return count_; }

 private:
  void find_near_corners(Index s, Index t);
  void find_crossings(Index s, Index t);
  void find_crossings_inside();
  bool beyond(const Edge& edge, Index t) const;
  bool consider_crossing(const Edge& e, const Edge& f);
  Index crossing_at(const Point& on_e, const Point& on_f);
  const Point& at(Index p) const { return state_.at(p); }

  SnapState& state_;
  SnapCuts& cuts_;
  PointGrid crossing_points_;
  Index first_ = 0;  // number of the first point that the overlay makes
  std::size_t count_ = 0;
  std::set<std::pair<Edge, Edge>> crossing_, crossed_before_;
};

}  // namespace collarmesh::repairing
