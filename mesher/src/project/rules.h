#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "collarmesh/geometry.h"
#include "common/cell_shapes.h"

/// Rules for vertices that move onto exact geometry, and for others that make room, on one rank or many.
namespace collarmesh::projection {

/// Limit of a vertex's move, relative to its shortest edge: a longer move would pass through other tets. Such
/// moves arise because the faces of a CAD file may be farther from their edges than features are from each
/// other.
inline constexpr double longest_way = 2;
/// Number of further attempts to move the vertices that were moved back.
inline constexpr unsigned retries = 2;
/// Least gain of a move that makes room, relative to the penalty before it.
inline constexpr double least_gain = 1e-3;

/// Returns whether an edge of a curve has turned by less than 60 degrees. If it turned by more, a vertex has
/// passed its neighbour.
inline bool on_course(const Vector& then, const Vector& now) {
  constexpr double least_cosine = 0.5;
  return dot(then, now) > least_cosine * norm(then) * norm(now);
}

/// Returns the score of a tet without positive volume, from -1 to 0: six times its volume, relative to the
/// cube of its longest edge.
inline double score_of_inverted(const std::array<Point, 4>& p, double six_volume) {
  double longest = 0;
  for (const auto& [i, j] : cell_shapes::corner_pairs)
    longest = std::max(longest, squared_distance(p[i], p[j]));
  return longest > 0 ? six_volume / (longest * std::sqrt(longest)) : -1;
}

}  // namespace collarmesh::projection
