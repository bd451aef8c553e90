#pragma once

#include <optional>
#include <vector>

#include "collarmesh/geometry.h"

namespace collarmesh::layering {

struct Direction {
  Vector direction;     ///< unit vector
  double least_cosine;  ///< least cosine of the angles between it and the normals of walls; positive
};

/// The search for the direction that is as steep as possible above all walls at a node, within the planes and
/// along the lines on which the node has to stay.
class DirectionSearch {
 public:
  /// Adds the normal of a wall: a unit vector that points away from the wall.
  void add_wall(const Vector& normal) { walls_.push_back(normal); }
  /// Adds the mean of the normals of walls that approximate one curved wall. If there are means, the
  /// direction is as steep as possible above them, unless it would be much less steep above one of the walls.
  void add_mean(const Vector& normal) { means_.push_back(normal); }
  void stay_in_plane(const Vector& normal) { planes_.push_back(normal); }
  void stay_on_line(const Vector& way) { lines_.push_back(way); }

  /// Returns the direction; nothing if no direction points away from all walls.
  std::optional<Direction> best() const;

 private:
  std::optional<Vector> only_way() const;
  Vector nearest_to_origin(const std::vector<Vector>& of) const;
  Vector nearest_from_mean() const;
  Vector in_plane(const Vector& v) const;
  std::optional<Direction> judge(const Vector& way) const;

  std::vector<Vector> walls_, means_, planes_, lines_;
};

}  // namespace collarmesh::layering
