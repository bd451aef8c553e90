#pragma once

#include <vector>

#include "collarmesh/geometry.h"
#include "common/flat_table.h"

namespace collarmesh::io {

/// A map from points to indices: points with equal coordinates (0 and -0 are equal) get one index. Appends
/// new points to `points`. Cost: expected constant per point.
class PointMerger {
 public:
  explicit PointMerger(std::vector<Point>& points) : points_(points), slots_(64, none) {}

  Index add(const Point& p) {
    if (2 * points_.size() >= slots_.size()) grow();
    Index& slot = find(p);
    if (slot == none) {
      slot = static_cast<Index>(points_.size());
      points_.push_back(p);
    }
    return slot;
  }

 private:
  /// Returns the slot that holds the point, or the free one where it belongs.
  Index& find(const Point& p) {
    return find_slot(slots_, hash_of(p), [&](Index i) { return points_[i] == p; });
  }
  void grow() {
    slots_.assign(2 * slots_.size(), none);
    for (std::size_t i = 0; i < points_.size(); ++i) find(points_[i]) = static_cast<Index>(i);
  }

  std::vector<Point>& points_;
  std::vector<Index> slots_;
};

}  // namespace collarmesh::io
