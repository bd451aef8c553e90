#pragma once

#include <array>
#include <memory>
#include <vector>

#include "check/region_locator.h"
#include "collarmesh/plc.h"
#include "common/distance_tree.h"
#include "location/triangle_hierarchy.h"
#include "predict/solid_angles.h"
#include "tolerance/curvature.h"

namespace collarmesh::prediction {

/// The properties of a complex that predictions for all sizes share: its curvature, its widths and the
/// distances of its features.
class Shape {
 public:
  /// Keeps the complex by reference. Cost: near linear.
  explicit Shape(const Plc& plc);

  const Plc& plc() const { return plc_; }
  const SolidAngles& angles() const { return angles_; }

  std::array<Point, 3> corners(Index triangle) const;
  std::size_t segment_count(Index curve) const;
  std::array<Point, 2> segment(Index curve, std::size_t number) const;

  /// Returns the radius of curvature at a triangle; infinite if the surface is flat there.
  double radius_of_triangle(Index triangle) const { return radii_.triangle[triangle]; }
  double radius_of_segment(Index curve, std::size_t number) const {
    return radii_.curve_segment[curve].empty() ? INFINITY : radii_.curve_segment[curve][number];
  }

  /// Returns the distance from a point on a patch to its curves; infinite if it has none.
  double distance_to_border(const Point& p, Index patch) const;
  /// Returns the distance from a point on a curve to another curve that runs along it on a common patch, or
  /// `widest` if that is smaller.
  double strip_width(const Point& p, Index curve, const Vector& along, double widest) const;
  /// Returns the distance from a point on a triangle, across a region, to a facing triangle of the same
  /// patch or of a patch that shares no curve with it; at most `widest`.
  double wall_width(const Point& p, Index triangle, double widest) const;
  /// Returns the nearest triangle and its distance. A `hint`, a triangle that is probably near, saves time.
  DistanceTree::Nearest nearest(const Point& p, Index hint = none) const { return tree_.nearest(p, 0, hint); }
  /// Returns the region at a point. `nearest`: the triangle nearest to it. Precondition: the point is not on
  /// the surface.
  Index region_at(const Point& p, Index nearest) const;

 private:
  /// The segments of a patch's curves.
  struct Border {
    std::unique_ptr<TriangleHierarchy> segments;
    std::vector<Index> curve;  // the curve of each segment
  };

  Border border_of(const Plc::Patch& patch) const;
  bool curves_meet(Index curve, Index other) const;
  bool patches_meet(Index patch, Index other) const;

  const Plc& plc_;
  CurvatureSizes radii_;
  SolidAngles angles_;
  TriangleHierarchy surface_;
  DistanceTree tree_;
  checks::RegionLocator locator_;
  std::vector<Border> borders_;  // by patch
};

}  // namespace collarmesh::prediction
