#pragma once

#include <utility>
#include <vector>

#include "repair/point_grid.h"
#include "repair/snap_state.h"

namespace collarmesh::repairing {

/// Points near each other become one.
class PointMerger {
 public:
  /// Keeps the state by reference. Points of triangles that are known are apart from each other already.
  PointMerger(SnapState& state, const std::vector<bool>& known);

  /// Merges the points that came since the last call, or whose triangles changed. Points that were compared
  /// before are apart from each other: new ones are compared with them and among themselves, in an order that
  /// does not depend on that of the input. Returns whether any were merged.
  bool merge();

 private:
  bool is_pinned(Index p) const { return p < pinned_.size() && pinned_[p]; }
  bool before(Index p, Index q) const;
  std::vector<Index> points_to_compare();
  void rename(const std::vector<std::pair<Index, Index>>& merged);

  SnapState& state_;
  std::vector<bool> pinned_;   // by point: of a segment or loose
  std::vector<bool> in_grid_;  // by point: apart from all others there
  PointGrid grid_;
};

}  // namespace collarmesh::repairing
