#pragma once

#include <optional>
#include <vector>

#include "collarmesh/plc.h"

namespace collarmesh::repairing {

/// Returns a place where a valid complex has features below a tolerance (absolute), if there is one: shorter
/// curves, features that come as close without meeting, and patches that meet at such a small angle that they
/// stay as close all along. Cost: O(n log n + k) for k pairs of near neighbours.
std::optional<Point> find_noise(const Plc& plc, double tolerance);

/// A place that makes refinement expensive.
struct Trouble {
  Point where;
  double cost;  ///< any unit
};

/// Returns features below a tolerance (absolute), the first of near ones, and creases of less than a degree,
/// which cost more the sharper they are. Cost: O(n log n + k) for k pairs of near neighbours.
std::vector<Trouble> find_troubles(const Plc& plc, double tolerance);

}  // namespace collarmesh::repairing
