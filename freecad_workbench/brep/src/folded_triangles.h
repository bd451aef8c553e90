#pragma once

#include <array>
#include <vector>

#include "collarmesh/geometry.h"

namespace collarmesh::brep {

/// Removes flat triangles from a face's triangulation by edge flips: corners that form a triangle in the
/// parameter plane may lie on one line in space, such as a ruling that ends in a cone's apex. If a corner is
/// within `height` (absolute) of the opposite side, the side is replaced by an edge that ends at the corner.
/// Sides at the border of the face stay. Cost: near linear.
void flip_flat_triangles(const std::vector<Point>& points, double height,
                         std::vector<std::array<Index, 3>>& triangles);

/// Repairs folds in a face's triangulation: edges where the surface turns by more than 90 degrees. Flips
/// edges, and merges points that lie inside the face (the points from `first_inner` on) with a neighbour if
/// the triangles that remain pass within `distance` (absolute) of the point. Some folds may remain. Cost:
/// near linear.
void unfold(const std::vector<Point>& points, Index first_inner, double distance,
            std::vector<std::array<Index, 3>>& triangles);

}  // namespace collarmesh::brep
