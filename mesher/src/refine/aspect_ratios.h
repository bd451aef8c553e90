#pragma once

#include <functional>

#include "refine/refined_mesh.h"

namespace collarmesh {

/// Extremes of R_v / r_v over mesh vertices (paper, section 1.2), where R_v is the radius of the smallest
/// ball around v that contains its Voronoi cell, and r_v the radius of the largest ball around v inside the
/// cell. Both are 0 if no vertex counts.
struct AspectRatios {
  double smallest = 0, largest = 0;
};

/// Returns the extremes over the vertices whose cells all satisfy `counts`.
AspectRatios aspect_ratios(const RefinedMesh& mesh, const std::function<bool(Index cell)>& counts);

}  // namespace collarmesh
