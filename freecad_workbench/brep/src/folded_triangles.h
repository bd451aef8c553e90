#pragma once

#include <array>
#include <vector>

#include "collarmesh/geometry.h"

namespace collarmesh::brep {

/// Returns the number of edges at which triangles of a face turn by more than 90 degrees, which no surface
/// does.
std::size_t count_folds(const std::vector<Point>& points, const std::vector<std::array<Index, 3>>& triangles);

/// Repairs triangles of a face that are folded onto each other. Flips edges, and merges points that lie
/// inside the face (those from `first_inner` on) with a neighbour if the surface stays within `distance`
/// (absolute) of them. Some folds may remain. Cost: near linear.
void unfold(const std::vector<Point>& points, Index first_inner, double distance,
            std::vector<std::array<Index, 3>>& triangles);

}  // namespace collarmesh::brep
