#pragma once

#include <span>
#include <vector>

#include "collarmesh/plc.h"
#include "collarmesh/polygon_soup.h"

namespace collarmesh::plc {

/// Returns warnings of bodies that are in the soups, but not in the complex made of them: connected facets
/// all of which welding within `distance` (absolute) or a repair has removed. Bodies without an extent do not
/// count. Cost: that of sorting the points.
std::vector<Plc::Warning> lost_bodies(std::span<const PolygonSoup> soups, const Plc& plc, double distance);

/// Regions whose volume no region of a repaired complex has (within 2%), with a place on each.
struct LostRegions {
  std::vector<Point> thin;    ///< no thicker than the tolerance allows
  double thin_volume = 0;     ///< volume of all thin ones
  std::vector<Point> others;  ///< now parts of larger regions, or split
};

/// Compares `before` with `after`, a repair of it. A region is thin if its thickness (twice the volume over
/// the area) is at most twice the `tolerance` (absolute). Cost: O(n log n).
LostRegions lost_regions(const Plc& before, const Plc& after, double tolerance);

}  // namespace collarmesh::plc
