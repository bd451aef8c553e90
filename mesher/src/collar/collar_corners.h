#pragma once

#include "collar/collar_system.h"
#include "collar/crease_sheets.h"
#include "collar/feature_hierarchy.h"
#include "location/curve_paths.h"

namespace collarmesh {

/// A search for the points that the mesh must have on the collar surface.
class CollarCorners {
 public:
  /// Keeps references to all arguments.
  CollarCorners(const Plc& plc, const FeatureHierarchy& features, const CurvePaths& paths,
                const CreaseSheets& sheets, std::vector<CornerPoint>& corners);

  /// Finds the places where the sheets at a crease cross the circle of two consecutive balls' spheres.
  void add_on_circle(const CollarLink& link, const CollarBall& a, const CollarBall& b);
  /// Finds three points where a smooth patch around a crease vertex (such as a cone around its apex) leaves
  /// the vertex's ball.
  void add_around(const CollarBall& ball);

 private:
  struct Circle {
    Point centre;
    Vector axis;  // unit vector
    double radius;
  };
  std::vector<Point> crossings(Index patch, const Circle& circle) const;

  const Plc& plc_;
  const FeatureHierarchy& features_;
  const CurvePaths& paths_;
  const CreaseSheets& sheets_;
  std::vector<CornerPoint>& corners_;
};

}  // namespace collarmesh
