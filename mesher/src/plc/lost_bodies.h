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

}  // namespace collarmesh::plc
