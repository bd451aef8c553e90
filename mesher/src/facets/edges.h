#pragma once

#include <span>
#include <vector>

#include "facets/draft.h"

namespace collarmesh::facets {

/// The undirected edges of some triangles, each with the triangle sides that lie on it.
/// Cost: O(n), four bytes each for about 14 n.
class EdgeTable {
 public:
  EdgeTable(std::span<const Corners> triangles, std::size_t point_count);

  Index size() const { return static_cast<Index>(ends_.size()); }
  /// Its two points, the smaller index first.
  const std::array<Index, 2>& ends(Index edge) const { return ends_[edge]; }
  /// The sides (3 t + i) on it, in order.
  std::span<const Index> sides(Index edge) const {
    return {sides_.data() + first_side_[edge], sides_.data() + first_side_[edge + 1]};
  }
  Index edge_of(Index side) const { return edge_of_side_[side]; }
  /// The edge between two points, none if there is none.
  Index find(Index a, Index b) const;
  /// The triangle's corners 1 and 2 were swapped. Cost: linear in the triangles on its sides.
  void turn(Index triangle);

 private:
  std::vector<std::array<Index, 2>> ends_;
  std::vector<Index> first_side_;  // by edge, and one more
  std::vector<Index> sides_;
  std::vector<Index> edge_of_side_;
  std::vector<Index> first_edge_;  // by smaller point, and one more
};

/// Does the side run from the smaller to the larger index?
inline bool ascending(std::span<const Corners> triangles, Index side) {
  const Corners& t = triangles[side / 3];
  return t[side % 3] < t[(side % 3 + 1) % 3];
}
inline Index apex(std::span<const Corners> triangles, Index side) {
  return triangles[side / 3][(side % 3 + 2) % 3];
}

}  // namespace collarmesh::facets
