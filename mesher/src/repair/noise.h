#pragma once

#include <optional>

#include "collarmesh/plc.h"

namespace collarmesh::repairing {

/// A place where a valid complex has features below a tolerance (absolute), if there is one: curves that are
/// shorter, features that come as close without meeting, and patches that meet at such a small angle that
/// they stay as close all along. Cost: O(n log n + k) for k pairs of near neighbours.
std::optional<Point> find_noise(const Plc& plc, double tolerance);

}  // namespace collarmesh::repairing
