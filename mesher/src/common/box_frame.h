#pragma once

#include <array>
#include <span>

#include "collarmesh/geometry.h"

namespace collarmesh {

/// Axes along which the boxes of triangles are small: the coordinate axes, or, if most triangles are long and
/// parallel to none of these, the axes of the triangles. With the coordinate axes, millions of boxes of
/// parallel needles would overlap.
class BoxFrame {
 public:
  /// Makes a frame of the coordinate axes.
  BoxFrame() = default;
  /// Makes a frame for these triangles. Cost: O(n).
  BoxFrame(std::span<const Point> points, std::span<const std::array<Index, 3>> triangles);

  bool turned() const { return turned_; }

  /// Extends the box by all points within `reach` of a point along each axis, with a margin for rounding
  /// errors.
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
