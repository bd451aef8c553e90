#pragma once

#include <array>
#include <vector>

#include "collarmesh/geometry.h"

namespace collarmesh::brep {

/// Flip triangles without height out of a face's triangulation: triangles of a parameter plane may lie on one
/// line in space, as those along a ruling that end in a cone's apex. Where a corner lies on the opposite
/// side, within `height` (absolute) of it, that side goes to the corner instead. Sides at the border of the
/// face stay. Cost: near linear.
void flip_flat_triangles(const std::vector<Point>& points, double height,
                         std::vector<std::array<Index, 3>>& triangles);

}  // namespace collarmesh::brep
