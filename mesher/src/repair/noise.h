#pragma once

#include "collarmesh/plc.h"

namespace collarmesh::repairing {

/// Does a valid complex have features below a tolerance (absolute)? Curves that are shorter, features that come
/// as close without meeting, and patches that meet at such a small angle that they stay as close all along.
/// Cost: O(n log n + k) for k pairs of near neighbours.
bool has_noise(const Plc& plc, double tolerance);

}  // namespace collarmesh::repairing
