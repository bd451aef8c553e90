#pragma once

#include <span>
#include <vector>

#include "facets/complex_draft.h"

namespace collarmesh::facets {

/// The undirected edges of n triangles, each with the triangle sides on it. Cost: O(n) time; about 11 n
/// numbers of four bytes for a closed surface.
class EdgeTable {
 public:
  EdgeTable(std::span<const Corners> triangles, std::size_t point_count);

  Index size() const { return static_cast<Index>(ends_.size()); }
  /// Returns the edge's two points, the smaller index first.
  const std::array<Index, 2>& ends(Index edge) const { return ends_[edge]; }
  /// Returns the triangle sides (3 t + i) on the edge, in order.
  std::span<const Index> sides(Index edge) const {
    return {sides_.data() + first_side_[edge], sides_.data() + first_side_[edge + 1]};
  }
  Index edge_of(Index side) const { return edge_of_side_[side]; }
  /// Returns the edge between two points, or none.
  Index find(Index a, Index b) const;
  /// Updates the table after corners 1 and 2 of a triangle were swapped. Cost: linear in the number of
  /// triangles on its edges.
  void turn(Index triangle);

 private:
  std::vector<std::array<Index, 2>> ends_;
  std::vector<Index> first_side_;  // by edge, plus one entry for the end
  std::vector<Index> sides_;
  std::vector<Index> edge_of_side_;
  std::vector<Index> first_edge_;  // by smaller point, plus one entry for the end
};

/// Returns whether the side runs from the smaller to the larger index.
inline bool ascending(std::span<const Corners> triangles, Index side) {
  const Corners& t = triangles[side / 3];
  return t[side % 3] < t[(side % 3 + 1) % 3];
}
inline Index apex(std::span<const Corners> triangles, Index side) {
  return triangles[side / 3][(side % 3 + 2) % 3];
}

}  // namespace collarmesh::facets
