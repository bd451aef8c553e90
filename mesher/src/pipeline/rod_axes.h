#pragma once

#include <optional>
#include <vector>

#include "constrained/sheathed_rods.h"
#include "location/triangle_hierarchy.h"

namespace collarmesh::pipeline {

/// The axes of rods, for measuring distances from them.
class RodAxes {
 public:
  /// Keeps a reference to the rods.
  explicit RodAxes(const std::vector<SheathedRod>& rods);
  RodAxes(const RodAxes&) = delete;
  RodAxes& operator=(const RodAxes&) = delete;

  /// Returns the distance from a point to the axis of one rod.
  double distance(Index rod, const Point& p) const;

  /// Returns whether a rod's axis has two places whose distance is above `along` along the axis, but below
  /// `across` in space.
  bool comes_near_itself(Index rod, double along, double across) const;

  /// Returns, sorted, the rods whose axes are at a distance of at most `room` times the reach of their sheath
  /// plus `more` from a point.
  std::vector<Index> rods_near(const Point& p, double room, double more) const;

 private:
  const std::vector<SheathedRod>& rods_;
  std::vector<Point> points_;
  std::vector<double> along_;       // by point: the length of the axis up to it
  std::vector<Index> first_point_;  // by rod: its first point; at the end, the number of points
  std::vector<Index> rod_of_;       // by piece of an axis
  std::optional<TriangleHierarchy> pieces_;
  std::vector<Index> common_rod_;  // by node: the rod of all pieces below it; none if there are several
  double most_reach_ = 0;
};

}  // namespace collarmesh::pipeline
