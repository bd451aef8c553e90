#pragma once

#include <vector>

#include "collarmesh/geometry.h"

namespace collarmesh::checks {

/// The distance from p to the segment ab, and the position of the nearest point on the segment (0 to 1).
struct NearestOnSegment {
  double distance, parameter;
};
NearestOnSegment nearest_on_segment(const Point& p, const Point& a, const Point& b);

/// A chain of segments. Positions on it are arc lengths from its start. A closed polyline repeats its first
/// point at the end.
class Polyline {
 public:
  /// Makes a polyline from at least two points.
  explicit Polyline(std::vector<Point> points);

  double length() const { return arc_.back(); }
  const std::vector<Point>& points() const { return points_; }

  struct Nearest {
    double arc, distance;
  };
  /// Returns the point nearest to p on the part between two positions. Cost: linear in the segments of that
  /// part, plus a bisection.
  Nearest nearest(const Point& p, double from, double to) const;
  Nearest nearest(const Point& p) const { return nearest(p, 0, length()); }

  Point at(double arc) const;

  /// The corners strictly between two positions: indices [first, last).
  struct Range {
    std::size_t first, last;
  };
  Range corners_between(double from, double to) const;

  /// Returns this closed polyline with another starting point.
  Polyline started_at(double arc) const;

 private:
  std::size_t segment_at(double arc) const;

  std::vector<Point> points_;
  std::vector<double> arc_;  // arc length at each point
};

}  // namespace collarmesh::checks
