#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "collarmesh/geometry.h"
#include "common/spatial_order.h"

namespace collarmesh {

/// A hierarchy of boxes that finds the nearest of many triangles, which may be degenerate.
class DistanceTree {
 public:
  using Triangle = std::array<Point, 3>;

  /// Builds the tree. Cost: O(n).
  explicit DistanceTree(std::vector<Triangle> triangles);

  struct Nearest {
    double distance;
    Index triangle;  ///< number given by the constructor's order; none if there are no triangles
  };
  /// Finds the triangle nearest to p. Ends early once one as near as `enough` is found. A `hint`, a triangle
  /// that is probably near, makes it faster.
  Nearest nearest(const Point& p, double enough = 0, Index hint = none) const;

 private:
  struct Node {
    Box box;
    // A leaf's triangles; count 0: `first` is the right child, and the left one follows the node.
    Index first, count;
  };
  static constexpr Index leaf_size = 2;

  void put_in_order();
  Index build(std::span<const SpatialKey> keys, Index first);
  double squared_distance_to(Index node, const Point& p) const;

  std::vector<Triangle> triangles_;  // in the order of the leaves
  std::vector<Index> number_;        // constructor's number of each triangle
  std::vector<Index> place_;         // inverse of number_
  std::vector<Node> nodes_;
};

}  // namespace collarmesh
