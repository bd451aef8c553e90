#pragma once

#include "collarmesh/geometry.h"

namespace collarmesh {

/// A translation without any rounding, which moves input that lies far from the origin close to it. On an
/// axis where min > 0 and max <= 2 min (or mirrored), subtracting the bound nearer to zero is exact
/// (Sterbenz).
class Frame {
 public:
  Frame() = default;
  explicit Frame(const Box& bounds) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double low = bounds.min[axis], high = bounds.max[axis];
      if (low > 0 && high <= 2 * low) shift_[axis] = low;
      if (high < 0 && low >= 2 * high) shift_[axis] = high;
    }
  }

  Point inside(const Point& p) const { return p - shift_; }
  Point outside(const Point& p) const { return p + shift_; }
  /// Returns the nearest point whose coordinates in the input are representable as doubles; only such points
  /// are inserted.
  Point rounded(const Point& p) const { return inside(outside(p)); }
  const Vector& shift() const { return shift_; }

 private:
  Vector shift_;
};

}  // namespace collarmesh
