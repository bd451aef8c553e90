#pragma once

#include <optional>
#include <vector>

#include "collarmesh/plc.h"

namespace collarmesh::repairing {

/// Returns a place where a valid complex has features below a tolerance (absolute), if there is one: curves
/// that are shorter, features that come closer without meeting, and patches that meet at such a small angle
/// that they stay closer everywhere. Cost: O(n log n + k) for k pairs of near neighbours.
std::optional<Point> find_noise(const Plc& plc, double tolerance);

/// A place that makes refinement expensive.
struct Trouble {
  Point where;
  double cost;  ///< relative to other costs
};

/// Returns features below a tolerance (absolute) and creases of less than a degree, which cost more the
/// sharper they are. Includes only as many pairs of near features as `Faults` keeps. Cost: O(n log n + k) for
/// k pairs of near neighbours.
std::vector<Trouble> find_troubles(const Plc& plc, double tolerance);

}  // namespace collarmesh::repairing
