#pragma once

#include "collar/collar_system.h"

namespace collarmesh {

/// Places the balls of a collar system up front (DESIGN section 9). Used by CollarSystem alone.
class CollarPlacement {
 public:
  CollarPlacement(const Plc& plc, std::span<const Point> points, std::span<const Crease> creases,
                  const std::function<double(const Point&)>& size, std::uint64_t seed,
                  CollarSystem& system);
  void place();

 private:
  Index place_at_vertex(Index vertex);
  void place_along_curve(Index curve);
  std::vector<double> centre_parameters(Index curve, double from, double to) const;
  double radius_on_curve(Index curve, double parameter) const;
  Point curve_point(Index curve, double parameter) const;
  Vector curve_direction(Index curve, double parameter) const;
  void add_circle_corners(const CollarLink& link);
  void add_pierced_corners(Index ball);
  double shrink();

  const Plc& plc_;
  std::span<const Point> points_;
  std::span<const Crease> creases_;
  const std::function<double(const Point&)>& size_;
  GapSize gap_;
  std::uint64_t random_state_;
  CollarSystem& system_;
  std::vector<std::vector<double>> lengths_;  // arc lengths of crease curves
};

}  // namespace collarmesh
