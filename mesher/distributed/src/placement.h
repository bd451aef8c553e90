#pragma once

#include <petscdmplex.h>

#include <algorithm>
#include <array>
#include <vector>

#include "collarmesh/distributed.h"

namespace collarmesh::distributed {

/// The shares of their displacement that vertices and mid-edge nodes keep after 0, 1, 2 and 3 steps back.
inline constexpr std::array<double, 4> shares{1, 0.5, 0.25, 0};

/// Marks the points with the longest displacement among `points`, so that they move back. Returns false if no
/// point has a displacement.
template <class Points, class WayOf>
bool mark_longest(const Points& points, const WayOf& way_of, std::vector<PetscInt>& marks) {
  double longest = 0;
  for (const auto point : points) longest = std::max(longest, way_of(point));
  for (const auto point : points)
    if (longest > 0 && way_of(point) == longest) marks[point] = 1;
  return longest > 0;
}

/// Moves the vertices on features of a mesh of first order onto the shape, and makes room for them; see
/// ParallelMesh::refine. All tets have positive volume before and after. Collective.
LevelReport place(DM dm, const Shape& shape, const AngleBounds& wanted);

}  // namespace collarmesh::distributed
