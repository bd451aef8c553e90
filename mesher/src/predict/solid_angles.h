#pragma once

#include <vector>

#include "collarmesh/plc.h"

namespace collarmesh::prediction {

/// The share of the directions around a feature that lead into regions, from 0 to 1: 1/2 on a patch that
/// bounds one region, 1/4 at an edge of a box, 1/8 at its corner.
struct SolidAngles {
  std::vector<double> of_patch, of_curve, of_vertex;
};

/// Computes these shares; for a curve, at its middle segment. Cost: linear.
SolidAngles solid_angles(const Plc& plc);

}  // namespace collarmesh::prediction
