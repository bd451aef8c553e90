#pragma once

#include <mutex>
#include <optional>

#include "collarmesh/plc.h"
#include "common/box_tree.h"
#include "common/distance_tree.h"

namespace collarmesh::checks {

/// A locator of points among the regions of a complex. Several threads may query it at once.
class RegionLocator {
 public:
  /// Keeps a reference to the complex.
  explicit RegionLocator(const Plc& plc) : plc_(plc) {}

  /// Returns the region of a point, 0 outside all regions. Precondition: the point is not on a patch. Follows
  /// a ray from the point to a place on the nearest triangle, and returns the region on the point's side of
  /// the first triangle that the ray meets, by exact arithmetic. If the ray meets the border of a triangle or
  /// lies in the plane of one, tries another place, then another triangle. Cost: the first call takes O(n log
  /// n) for n triangles; later calls take as long as finding the nearest triangle: logarithmic for most
  /// points.
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
