#pragma once

#include <functional>

#include "refine/refined_mesh.h"

namespace collarmesh {

/// Extremes of R_v / r_v over mesh vertices (paper, section 1.2): the radii of the smallest ball around v
/// that contains its Voronoi cell and of the largest ball inside the cell. 0 if there are no vertices.
struct AspectRatios {
  double smallest = 0, largest = 0;
};

/// Returns the ratios of the vertices all of whose cells count.
AspectRatios aspect_ratios(const RefinedMesh& mesh, const std::function<bool(Index cell)>& counts);

}  // namespace collarmesh
