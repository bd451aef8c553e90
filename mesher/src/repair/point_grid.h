#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "collarmesh/geometry.h"

namespace collarmesh::repairing {

/// Points in a hashed grid, for finding points within a distance.
class PointGrid {
 public:
  /// Makes an empty grid. `reach` is absolute and positive. While the grid is in use, points may be appended,
  /// but must not move.
  PointGrid(const std::vector<Point>& points, double reach);

  void add(Index p);

  /// Returns the nearest point within the reach that `accept(point)` accepts; among equally near points the
  /// lexicographically first one; `none` if there is none.
  template <class Accept>
  Index nearest(const Point& p, const Accept& accept) const {
    Index best = none;
    double least = reach_ * reach_;
    for_each_cell(p, [&](std::uint64_t cell) {
      for (Index i = first_[cell & mask()]; i != none; i = entries_[i].next) {
        const Index q = entries_[i].point;
        const double d = squared_distance(p, points_[q]);
        if (d > least || !accept(q)) continue;
        if (d == least && best != none && !before(q, best)) continue;
        least = d;
        best = q;
      }
    });
    return best;
  }

  /// Calls visit(point) for every point within the reach, for some of them more than once.
  template <class Visit>
  void for_each_near(const Point& p, const Visit& visit) const {
    for_each_cell(p, [&](std::uint64_t cell) {
      for (Index i = first_[cell & mask()]; i != none; i = entries_[i].next)
        if (squared_distance(p, points_[entries_[i].point]) <= reach_ * reach_) visit(entries_[i].point);
    });
  }

 private:
  struct Entry {
    Index point, next;
  };
  static constexpr double cells_by_reach = 4;

  std::uint64_t mask() const { return first_.size() - 1; }
  std::int64_t cell(double x) const;
  // Returns the key of a cell. Different cells may share a key, which only costs time.
  static std::uint64_t key(std::int64_t x, std::int64_t y, std::int64_t z);
  bool before(Index p, Index q) const;
  void grow();

  template <class Visit>
  void for_each_cell(const Point& p, const Visit& visit) const {
    std::array<std::int64_t, 3> low, high;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low[axis] = cell(p[axis] - reach_);
      high[axis] = cell(p[axis] + reach_);
    }
    for (std::int64_t x = low[0]; x <= high[0]; ++x)
      for (std::int64_t y = low[1]; y <= high[1]; ++y)
        for (std::int64_t z = low[2]; z <= high[2]; ++z) visit(key(x, y, z));
  }

  const std::vector<Point>& points_;
  double reach_;
  std::vector<Index> first_;  // by key: first entry of a linked list
  std::vector<Entry> entries_;
};

}  // namespace collarmesh::repairing
