#pragma once

#include <array>
#include <span>

#include "collarmesh/geometry.h"

namespace collarmesh {

/// Axes along which the boxes of triangles are small: the coordinate axes or, if boxes along these would be
/// much larger, the main directions of the triangles' edges. The boxes of millions of parallel needles would
/// overlap if they were along coordinate axes.
class BoxFrame {
 public:
  /// Makes a frame of the coordinate axes.
  BoxFrame() = default;
  /// Makes a frame for these triangles. Cost: O(n) for n triangles.
  BoxFrame(std::span<const Point> points, std::span<const std::array<Index, 3>> triangles);

  bool turned() const { return turned_; }

  /// Extends a box along the frame's axes to contain all points at most `reach` away from p along each axis,
  /// with a margin for rounding errors.
  void add(Box& box, const Point& p, double reach = 0) const {
    const Point q =
        turned_ ? Point{dot(axes_[0], p - origin_), dot(axes_[1], p - origin_), dot(axes_[2], p - origin_)}
                : p;
    const double margin = reach + error_;
    box.add(q - Vector{margin, margin, margin});
    box.add(q + Vector{margin, margin, margin});
  }

 private:
  bool turned_ = false;
  Point origin_;
  std::array<Vector, 3> axes_;
  double error_ = 0;
};

}  // namespace collarmesh
