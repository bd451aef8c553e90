#pragma once

#include <optional>
#include <vector>

#include "collarmesh/plc.h"

namespace collarmesh::repairing {

/// Returns a place where a valid complex has features below a tolerance (absolute), if there is one: curves
/// shorter than the tolerance, features that come closer to each other than the tolerance without meeting,
/// and patches that meet at so small an angle that they stay closer to each other than the tolerance. Cost:
/// O(n log n + k) for k pairs of near neighbours.
std::optional<Point> find_noise(const Plc& plc, double tolerance);

/// A place that makes refinement expensive.
struct Trouble {
  Point where;
  double cost;  ///< without a unit; to be compared with other costs
};

/// Returns a trouble for each feature below a tolerance (absolute) and each crease with an angle below one
/// degree; the sharper a crease, the higher its cost. Includes only as many pairs of near features as
/// `Faults` keeps. Cost: O(n log n + k) for k pairs of near neighbours.
std::vector<Trouble> find_troubles(const Plc& plc, double tolerance);

}  // namespace collarmesh::repairing
