#pragma once

#include "collar/collar_system.h"

namespace collarmesh {

/// Places the balls of a collar system up front (DESIGN section 9). Used by CollarSystem alone.
class CollarPlacement {
 public:
  CollarPlacement(const Plc& plc, std::span<const Point> points, std::span<const Crease> creases,
                  const std::function<double(const Point&)>& size, double distance,
                  std::uint64_t seed, CollarSystem& system);
  void place();

 private:
  /// A side of a patch at a crease: the direction in which it leaves the curve.
  struct Sheet {
    Index patch;
    Vector direction;  // unit, orthogonal to the curve
  };

  Index place_at_vertex(Index vertex);
  void place_along_curve(Index curve);
  void place_around_closed_curve(Index curve);
  std::vector<double> centre_parameters(Index curve, double from, double to) const;
  Index add_ball_on_curve(Index curve, double parameter);
  double radius_on_curve(Index curve, double parameter) const;
  double own_radius(Index curve, double parameter) const;
  double flat_radius(Index curve, double parameter, double radius) const;
  Point curve_point(Index curve, double parameter) const;
  std::size_t curve_segment(Index curve, double parameter) const;
  void find_sheets(const std::vector<Index>& vertices);
  bool leaves_chord(Index patch, const Point& a, const Point& b) const;
  double flat_radius_at(Index vertex, double radius) const;
  std::vector<Sheet> sheets_at(Index curve, double parameter) const;
  Point sheet_point(const Sheet& sheet, const Point& centre, const Vector& axis, double radius) const;
  void add_circle_corners(const CollarLink& link);
  double shrink();

  const Plc& plc_;
  std::span<const Point> points_;
  std::span<const Crease> creases_;
  const std::function<double(const Point&)>& size_;
  GapSize gap_;
  std::uint64_t random_state_;
  CollarSystem& system_;
  std::vector<std::vector<double>> lengths_;  // arc lengths of all curves
  double distance_;                           // tolerance on smooth patches and curves
  // Triangles at the segments of crease curves, sorted: the segment's points, the triangle.
  std::vector<std::pair<std::array<Index, 2>, Index>> sheets_;
  std::vector<std::pair<Index, Index>> fans_;  // points of crease vertices, triangles there; sorted
};

}  // namespace collarmesh
