#pragma once

#include "collar/collar_system.h"
#include "collar/crease_sheets.h"
#include "collar/flatness.h"
#include "collar/gap_size.h"
#include "location/curve_paths.h"

namespace collarmesh {

/// Places the balls of a collar system up front. Used by CollarSystem alone.
class CollarPlacement {
 public:
  CollarPlacement(const Plc& plc, std::span<const Point> points, std::span<const Crease> creases,
                  const CollarOptions& options, CollarSystem& system);
  /// False when it was stopped.
  bool place();

 private:
  /// The radii that balls along a curve may have: at samples, from one parameter to another.
  struct Profile {
    std::vector<double> parameters, radii;
    std::vector<double> steps;  ///< how many radii from the first sample to each: the integral of 1 / radius
    double radius(double parameter) const;
    double parameter(double step) const;
  };

  Index place_at_vertex(Index vertex);
  void place_on_curve(Index curve);
  Profile make_profile(Index curve, double from, double to) const;
  double radius_for_gap(Index curve, double parameter) const;
  std::vector<double> centres(const Profile& profile) const;
  Index add_ball(Index curve, double parameter, double radius);
  double shrink();
  bool stopped();

  const Plc& plc_;
  std::span<const Point> points_;
  const CollarOptions& options_;
  CollarSystem& system_;
  std::vector<bool> is_crease_curve_;
  std::vector<Index> vertices_;  // with a ball
  CurvePaths paths_;
  const FeatureHierarchy& features_;
  GapSize gap_;
  CreaseSheets sheets_;
  Flatness flatness_;
  std::uint64_t random_state_;
  bool stopped_ = false;
};

}  // namespace collarmesh
