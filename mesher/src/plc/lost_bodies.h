#pragma once

#include <span>
#include <vector>

#include "collarmesh/plc.h"
#include "collarmesh/polygon_soup.h"

namespace collarmesh::plc {

/// Warnings of bodies that are in the soups, but not in the complex made of them: facets that hang together,
/// of which welding within `distance` (absolute) or a repair has left none. Bodies without an extent are
/// none. Cost: that of sorting the points.
std::vector<Plc::Warning> lost_bodies(std::span<const PolygonSoup> soups, const Plc& plc, double distance);

/// Regions that no region of a repaired complex has the volume of (within 2%), a place on each.
struct LostRegions {
  std::vector<Point> thin;    ///< no thicker than the tolerance allows
  double thin_volume = 0;     ///< of all of them
  std::vector<Point> others;  ///< parts of larger ones now, or several
};

/// Compares `before` with `after`, a repair of it. Thin is what is no thicker than twice the `tolerance`
/// (absolute; by twice the volume over the area). Cost: O(n log n).
LostRegions lost_regions(const Plc& before, const Plc& after, double tolerance);

}  // namespace collarmesh::plc
