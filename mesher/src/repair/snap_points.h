#pragma once

#include <utility>
#include <vector>

#include "repair/point_grid.h"
#include "repair/snap_state.h"

namespace collarmesh::repairing {

/// Replaces points by others, given as pairs: a point, and the one that takes its place. Triangles and
/// segments that become degenerate are removed.
void rename_points(SnapState& state, const std::vector<std::pair<Index, Index>>& merged);

/// The step of snapping that merges points near each other.
class PointMerger {
 public:
  /// Keeps a reference to the state. The points of `known` triangles must already be farther from each other
  /// than the limit.
  PointMerger(SnapState& state, const std::vector<bool>& known);

  /// Merges points that are new, or whose triangles have changed, since the last call. Compares new points
  /// with points compared before and with each other, in an order that does not depend on their numbers.
  /// Returns whether any points were merged.
  bool merge();

 private:
  bool is_pinned(Index p) const { return p < pinned_.size() && pinned_[p]; }
  bool before(Index p, Index q) const;
  std::vector<Index> points_to_compare();
  void keep_pinned(const std::vector<std::pair<Index, Index>>& merged);

  SnapState& state_;
  std::vector<bool> pinned_;   // by point: whether it is loose or the end of a segment
  std::vector<bool> in_grid_;  // by point: whether it is in the grid; points there are not near each other
  PointGrid grid_;
};

}  // namespace collarmesh::repairing
