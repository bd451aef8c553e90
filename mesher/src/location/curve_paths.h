#pragma once

#include <array>
#include <span>
#include <vector>

#include "collarmesh/plc.h"

namespace collarmesh {

/// A point on a curve, and the arc length of the curve up to it.
struct PlaceOnCurve {
  double parameter;
  Point point;
};

/// The curves of a complex, parametrized by arc length. On a closed curve parameters wrap around.
class CurvePaths {
 public:
  /// Keeps both by reference; `points` are those of the complex, possibly in another frame.
  CurvePaths(const Plc& plc, std::span<const Point> points);

  double length(Index curve) const { return lengths_[curve].back(); }
  /// Returns the arc lengths of the polyline's points; the last entry is the whole length.
  const std::vector<double>& lengths(Index curve) const { return lengths_[curve]; }
  /// Returns the index of the polyline's segment at a parameter.
  std::size_t segment(Index curve, double parameter) const;
  /// Returns the two points of a segment of the polyline.
  std::array<Index, 2> segment_ends(Index curve, std::size_t segment) const;
  Point point(Index curve, double parameter) const;

 private:
  double wrapped(Index curve, double parameter) const;

  const Plc& plc_;
  std::span<const Point> points_;
  std::vector<std::vector<double>> lengths_;
};

}  // namespace collarmesh
