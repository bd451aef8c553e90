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

  /// Adds corner points on the circle in which the spheres of two consecutive balls meet: the places where
  /// the sheets at the link's curve cross it.
  void add_on_circle(const CollarLink& link, const CollarBall& a, const CollarBall& b);
  /// Adds corner points for each smooth patch that has the ball's vertex in its interior (such as a cone with
  /// its apex): up to three points where the patch leaves the ball.
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
