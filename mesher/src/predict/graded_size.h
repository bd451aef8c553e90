#pragma once

#include <array>
#include <vector>

#include "collarmesh/geometry.h"

namespace collarmesh::prediction {

/// Graded sizes: the edge length at a point is the smallest that any source asks for there; the length that a
/// source asks for grows with the distance from it.
class GradedSize {
 public:
  /// A point, segment or triangle (as three corners, possibly equal) with its edge length.
  struct Source {
    std::array<Point, 3> corners;
    double size;
    double growth;  // growth per unit length
  };

  /// Builds the hierarchy. Cost: O(n log n).
  explicit GradedSize(std::vector<Source> sources);

  /// Returns the largest growth.
  double growth() const { return growth_; }
  /// Returns the size at a point, at most `largest`.
  double at(const Point& p, double largest) const;

 private:
  struct Node {
    Box box;
    double least;        // smallest size of the sources below
    double growth;       // smallest growth of the sources below
    Index first, count;  // its sources; count 0: the children are the next node and the node `first`
  };
  static constexpr Index leaf_size = 4;

  Index build(Index first, Index last);

  double growth_ = 0;
  std::vector<Source> sources_;
  std::vector<Node> nodes_;
};

}  // namespace collarmesh::prediction
