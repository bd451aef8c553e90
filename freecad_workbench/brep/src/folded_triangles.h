#pragma once

#include <array>
#include <vector>

#include "collarmesh/geometry.h"

namespace collarmesh::brep {

/// Number of edges at which triangles of a face turn by more than 90 degrees, as no surface does.
std::size_t count_folds(const std::vector<Point>& points, const std::vector<std::array<Index, 3>>& triangles);

/// Cut anew where triangles of a face are folded onto each other: edges are flipped, and points from
/// `first_inner` on, which lie inside of the face, become one with a neighbour where the surface then keeps
/// within `distance` (absolute) of them. Folds may stay. Cost: near linear.
void unfold(const std::vector<Point>& points, Index first_inner, double distance,
            std::vector<std::array<Index, 3>>& triangles);

}  // namespace collarmesh::brep
