#pragma once

#include <array>
#include <vector>

#include "collarmesh/geometry.h"

namespace collarmesh::prediction {

/// Graded sizes: the edge length at any point is the least one that the sources ask for; it grows with the
/// distance from them.
class GradedSize {
 public:
  /// A point, segment or triangle (corners may be equal) with its edge length.
  struct Source {
    std::array<Point, 3> corners;
    double size;
    double growth;  // per unit length
  };

  /// Cost: O(n log n).
  explicit GradedSize(std::vector<Source> sources);

  /// The largest.
  double growth() const { return growth_; }
  /// At most `largest`.
  double at(const Point& p, double largest) const;

 private:
  struct Node {
    Box box;
    double least;        // size below
    double growth;       // the least below
    Index first, count;  // sources; count 0: the children are the next node and `first`
  };
  static constexpr Index leaf_size = 4;

  Index build(Index first, Index last);

  double growth_ = 0;
  std::vector<Source> sources_;
  std::vector<Node> nodes_;
};

}  // namespace collarmesh::prediction
