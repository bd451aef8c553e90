#pragma once

#include <algorithm>
#include <cmath>

#include "collarmesh/geometry.h"

namespace collarmesh {

/// A box given by its centre and half of its sides, widened by more than the rounding errors of its tests.
/// These tests need fewer operations than tests of minima and maxima. They have no branches, because it is
/// unpredictable which comparison fails.
struct CentredBox {
  Point centre;
  Vector half;

  CentredBox() = default;
  /// Returns a box that meets nothing.
  static CentredBox empty() {
    CentredBox box;
    box.half = {-INFINITY, -INFINITY, -INFINITY};
    return box;
  }
  explicit CentredBox(const Box& box) : centre(0.5 * (box.min + box.max)) {
    const double slack = 1e-14 * (std::max(std::fabs(box.min.x), std::fabs(box.max.x)) +
                                  std::max(std::fabs(box.min.y), std::fabs(box.max.y)) +
                                  std::max(std::fabs(box.min.z), std::fabs(box.max.z)));
    const Vector sides = 0.5 * (box.max - box.min);
    half = {sides.x * widen + slack, sides.y * widen + slack, sides.z * widen + slack};
  }

  bool meets(const CentredBox& other) const {
    const Vector d = centre - other.centre;
    const double x = std::fabs(d.x) - (half.x + other.half.x);
    const double y = std::fabs(d.y) - (half.y + other.half.y);
    const double z = std::fabs(d.z) - (half.z + other.half.z);
    return std::max(std::max(x, y), z) <= 0;
  }

  /// Returns a lower bound on the squared distance from p; 0 inside.
  double squared_distance(const Point& p) const {
    const Vector d = p - centre;
    return squared_norm({std::max(std::fabs(d.x) - half.x, 0.0), std::max(std::fabs(d.y) - half.y, 0.0),
                         std::max(std::fabs(d.z) - half.z, 0.0)});
  }

  static constexpr double widen = 1 + 1e-12;
};

/// A segment prepared for tests against many boxes by separating axes (Akenine-Moeller, Haines, Hoffman:
/// Real-Time Rendering, segment against box). Conservative: never misses a box that the segment meets.
class SegmentAgainstBoxes {
 public:
  SegmentAgainstBoxes(const Point& p, const Point& q) : half_(0.5 * (q - p)) {
    Box box;
    box.add(p);
    box.add(q);
    range_ = CentredBox(box);
  }

  bool may_meet(const CentredBox& box) const {
    const Vector m = box.centre - range_.centre;
    const Vector &e = box.half, &reach = range_.half;
    const double x = std::fabs(m.x) - (e.x + reach.x), y = std::fabs(m.y) - (e.y + reach.y),
                 z = std::fabs(m.z) - (e.z + reach.z);
    if (std::max(std::max(x, y), z) > 0) return false;
    const double u = std::fabs(m.y * half_.z - m.z * half_.y) - (e.y * reach.z + e.z * reach.y);
    const double v = std::fabs(m.z * half_.x - m.x * half_.z) - (e.x * reach.z + e.z * reach.x);
    const double w = std::fabs(m.x * half_.y - m.y * half_.x) - (e.x * reach.y + e.y * reach.x);
    return std::max(std::max(u, v), w) <= 0;
  }

 private:
  Vector half_;
  CentredBox range_;
};

}  // namespace collarmesh
