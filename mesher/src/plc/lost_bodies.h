#pragma once

#include <span>
#include <vector>

#include "collarmesh/plc.h"
#include "collarmesh/polygon_soup.h"

namespace collarmesh::plc {

/// Returns warnings of lost bodies: sets of connected facets in the soups that welding within `distance`
/// (absolute) or repair removed completely from the complex. Counts only bodies that have at least four
/// facets and an extent of at most 100 times `distance`. Cost: that of sorting the points.
std::vector<Plc::Warning> lost_bodies(std::span<const PolygonSoup> soups, const Plc& plc, double distance);

/// The regions whose volume (within 2%) no region of the repaired complex has, each given by a
/// point of its boundary.
struct LostRegions {
  std::vector<Point> thin;    ///< thin regions, see `lost_regions`
  double thin_volume = 0;     ///< volume of all thin regions
  std::vector<Point> others;  ///< regions that became parts of larger ones, or were split
};

/// Compares `before` with `after`, its repair. A region is thin if its thickness (twice the volume divided by
/// the area) is at most twice the `tolerance` (absolute). Cost: O(n log n).
LostRegions lost_regions(const Plc& before, const Plc& after, double tolerance);

}  // namespace collarmesh::plc
