#pragma once

#include "collar/collar_corners.h"
#include "collar/collar_system.h"
#include "collar/crease_sheets.h"
#include "collar/flatness.h"
#include "collar/gap_size.h"
#include "location/curve_paths.h"

namespace collarmesh {

/// The placement of the balls of a collar system and of the corner points on their circles. Throws PlcError
/// where a ball would be too small (CollarOptions::too_small).
class CollarPlacement {
 public:
  /// Keeps references to all arguments. `system` has the creases; `gap` gives the gap sizes there, which
  /// limit the radii.
  CollarPlacement(const Plc& plc, std::span<const Point> points, GapSize& gap, const CollarOptions& options,
                  CollarSystem& system);
  /// Places balls on all creases. Returns false if it was stopped.
  bool place_all();
  /// Places the ball at a vertex. Precondition: the vertex belongs to a crease and has no ball yet.
  void place_at_vertex(Index vertex);
  /// Places the balls on a curve. `vertices` are places of mesh vertices, in their order along the curve.
  /// Balls are centred on them, except where two centres would be too near to each other, so that centres do
  /// not lie just beside mesh vertices. Preconditions: the curve is a crease and has no balls yet, and the
  /// vertices at its ends have their balls.
  void place_on_curve(Index curve, std::span<const PlaceOnCurve> vertices = {});

 private:
  /// The radii that balls along a curve may have, at samples along the curve.
  struct Profile {
    std::vector<double> parameters, radii;
    std::vector<double> steps;  ///< number of radii from the first sample to each sample: the integral of 1 /
                                ///< radius
    double radius(double at) const;
    double parameter(double step) const;
    double step(double parameter) const;
  };

  void add_at_vertex(Index vertex);
  void add_on_curve(Index curve, std::span<const PlaceOnCurve> vertices);
  void link(Index a, Index b, Index curve, double from, double to);
  Profile make_profile(Index curve, double from, double to);
  double radius_for_gap(Index curve, double parameter);
  std::vector<PlaceOnCurve> centres(Index curve, const Profile& profile,
                                    std::span<const PlaceOnCurve> vertices) const;
  Index add_ball(Index curve, const PlaceOnCurve& centre, double radius);
  double shrink();
  bool stopped(std::size_t more_balls = 0);
  void require_room(double radius, const Point& where) const;

  const Plc& plc_;
  std::span<const Point> points_;
  const CollarOptions options_;
  CollarSystem& system_;
  CurvePaths paths_;
  const FeatureHierarchy& features_;
  GapSize& gap_;
  CreaseSheets sheets_;
  Flatness flatness_;
  CollarCorners corners_;
  std::uint64_t random_state_;
  bool stopped_ = false;
};

}  // namespace collarmesh
