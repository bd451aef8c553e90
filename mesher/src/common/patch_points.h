#pragma once

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

#include "collarmesh/plc.h"

namespace collarmesh {

/// The points of each patch's triangles.
class PatchPoints {
 public:
  /// Finds the points. Cost: O(n log n).
  explicit PatchPoints(const Plc& plc) {
    std::vector<Index> seen_by(plc.points.size(), none);  // by point: the last patch that had it
    for (Index patch = 0; patch < plc.patches.size(); ++patch) {
      const std::size_t first = points_.size();
      const Plc::Patch& p = plc.patches[patch];
      for (Index t = p.first_triangle; t < p.first_triangle + p.triangle_count; ++t)
        for (const Index point : plc.triangles[t].points)
          if (std::exchange(seen_by[point], patch) != patch) points_.push_back(point);
      std::sort(points_.begin() + static_cast<std::ptrdiff_t>(first), points_.end());
      first_.push_back(points_.size());
    }
  }

  /// Returns the points of a patch, sorted, without duplicates.
  std::span<const Index> operator[](Index patch) const {
    return std::span(points_).subspan(first_[patch], first_[patch + 1] - first_[patch]);
  }

 private:
  std::vector<Index> points_;
  std::vector<std::size_t> first_{0};  // first entry in points_, by patch
};

}  // namespace collarmesh
