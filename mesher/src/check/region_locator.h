#pragma once

#include <mutex>
#include <optional>

#include "collarmesh/plc.h"
#include "common/box_tree.h"
#include "common/distance_tree.h"

namespace collarmesh::checks {

/// Tells which region of a complex a point lies in. Several threads may ask at once.
class RegionLocator {
 public:
  /// Kept by reference.
  explicit RegionLocator(const Plc& plc) : plc_(plc) {}

  /// 0 outside of all. Precondition: the point is not on a patch. Looks from the point to places on the
  /// nearest triangle, and at the side from which the first triangle on the way is seen: by exact
  /// arithmetic, and again towards another place, then another triangle, when a way meets the border of a
  /// triangle or lies in a plane of one. Cost: the first
  /// time O(n log n) for n triangles, then like that of the nearest triangle, logarithmic for most points.
  Index region_at(const Point& p) const;

 private:
  struct Trees {
    DistanceTree triangles;
    BoxTree boxes;
  };
  const Trees& trees() const;
  Index region_on_the_way(const Point& p, const Point& target) const;

  const Plc& plc_;
  mutable std::once_flag once_;
  mutable std::optional<Trees> trees_;
};

}  // namespace collarmesh::checks
