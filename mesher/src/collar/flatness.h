#pragma once

#include "collar/crease_sheets.h"
#include "collar/feature_hierarchy.h"
#include "collarmesh/surface_tolerance.h"
#include "location/curve_paths.h"

namespace collarmesh {

/// A limit on the radius of a ball at a crease, so that straight edges and flat triangles can replace the
/// curved features inside it. Inside the ball the features deviate from their chords by no more than the
/// distance tolerance; the ball meets its curve in one arc and each smooth patch in one piece; the radius is
/// at most a third of the distance to other pieces of these features.
class Flatness {
 public:
  /// Keeps references to all arguments.
  Flatness(const Plc& plc, const FeatureHierarchy& features, const CurvePaths& paths,
           const CreaseSheets& sheets, SurfaceTolerance tolerance);

  /// Returns whether the curve or a patch at it is curved.
  bool matters_on(Index curve) const;
  /// Return the largest permitted radius of a ball there, at most `radius`.
  double radius_on_curve(Index curve, double parameter, double radius) const;
  double radius_at_vertex(Index vertex, double radius) const;

 private:
  template <class Deviation>
  static double shrunk(double radius, double tolerance, const Deviation& deviation);
  double off_chord(Index curve, double from, double to) const;
  double off_patch(const Sheet& sheet, const Point& centre, double radius) const;
  double off_spoke(Index patch, const Point& centre, const Point& end) const;
  double off_arc(Index patch, const Point& centre, double radius) const;
  double other_arcs(Index curve, double parameter, double reach) const;
  double other_sheets(Index patch, const Point& centre, double reach,
                      const std::array<Index, 2>& points) const;

  const Plc& plc_;
  const FeatureHierarchy& features_;
  const CurvePaths& paths_;
  const CreaseSheets& sheets_;
  SurfaceTolerance tolerance_;
};

}  // namespace collarmesh
