#include "repair/point_grid.h"

#include <algorithm>
#include <cmath>

namespace collarmesh::repairing {

PointGrid::PointGrid(const std::vector<Point>& points, double reach) : points_(points), reach_(reach) {
  first_.assign(1024, none);
}

std::int64_t PointGrid::cell(double x) const {
  // Clamping does no harm: this many cells away from 0, different doubles are farther apart than the reach.
  constexpr double most = 0x1p62;
  return static_cast<std::int64_t>(std::clamp(std::floor(x / (cells_by_reach * reach_)), -most, most));
}

std::uint64_t PointGrid::key(std::int64_t x, std::int64_t y, std::int64_t z) {
  std::uint64_t h = 0;
  for (const std::int64_t i : {x, y, z}) {
    h = (h ^ static_cast<std::uint64_t>(i)) * 0x9e3779b97f4a7c15ULL;
    h ^= h >> 31U;
  }
  return h;
}

bool PointGrid::before(Index p, Index q) const {
  const Point &a = points_[p], &b = points_[q];
  return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z != b.z ? a.z < b.z : p < q;
}

void PointGrid::add(Index p) {
  if (entries_.size() >= first_.size()) grow();
  const Point& at = points_[p];
  Index& first = first_[key(cell(at.x), cell(at.y), cell(at.z)) & mask()];
  entries_.push_back({p, first});
  first = static_cast<Index>(entries_.size() - 1);
}

void PointGrid::grow() {
  first_.assign(4 * first_.size(), none);
  for (Index i = 0; i < entries_.size(); ++i) {
    const Point& at = points_[entries_[i].point];
    Index& first = first_[key(cell(at.x), cell(at.y), cell(at.z)) & mask()];
    entries_[i].next = first;
    first = i;
  }
}

}  // namespace collarmesh::repairing
