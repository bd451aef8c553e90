#pragma once

#include <array>
#include <vector>

#include "collarmesh/geometry.h"

namespace collarmesh::brep {

/// Returns the number of edges at which triangles of a face turn by more than 90 degrees, as no surface does.
std::size_t count_folds(const std::vector<Point>& points, const std::vector<std::array<Index, 3>>& triangles);

/// Repairs triangles of a face that are folded onto each other: flips edges, and merges points from
/// `first_inner` on, which lie inside the face, with a neighbour if the surface then stays within `distance`
/// (absolute) of them. Folds may stay. Cost: near linear.
void unfold(const std::vector<Point>& points, Index first_inner, double distance,
            std::vector<std::array<Index, 3>>& triangles);

}  // namespace collarmesh::brep
