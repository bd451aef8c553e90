#pragma once

#include <array>
#include <vector>

#include "collarmesh/geometry.h"
#include "common/hierarchy.h"

namespace collarmesh {

/// A hierarchy of boxes that finds the nearest of many triangles, which may be degenerate.
class DistanceTree {
 public:
  using Triangle = std::array<Point, 3>;

  /// Builds the tree. Cost: O(n).
  explicit DistanceTree(std::vector<Triangle> triangles);

  struct Nearest {
    double distance;
    Index triangle;  ///< number of the triangle in the constructor's list; none if there are no triangles
  };
  /// Finds the triangle nearest to p, or any triangle at most `enough` away, which ends the search early. A
  /// `hint`, a triangle that is probably near, makes the search faster.
  Nearest nearest(const Point& p, double enough = 0, Index hint = none) const;

 private:
  void put_in_order();

  std::vector<Triangle> triangles_;  // in the order of the leaves
  std::vector<Index> number_;        // constructor's number of each triangle
  std::vector<Index> place_;         // inverse of number_
  Hierarchy<Box> tree_;
};

}  // namespace collarmesh
