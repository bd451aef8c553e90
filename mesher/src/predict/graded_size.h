#pragma once

#include <array>
#include <vector>

#include "collarmesh/geometry.h"
#include "common/hierarchy.h"

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

  /// Builds a hierarchy of boxes around the sources. Cost: O(n log n).
  explicit GradedSize(std::vector<Source> sources);

  /// Returns the largest growth.
  double growth() const { return growth_; }
  /// Returns the size at a point, at most `largest`.
  double at(const Point& p, double largest) const;

 private:
  struct Bounds {
    Box box;
    double least = INFINITY;   // smallest size of the sources below
    double growth = INFINITY;  // smallest growth of the sources below
  };

  double growth_ = 0;
  std::vector<Source> sources_;
  Hierarchy<Bounds> tree_;
};

}  // namespace collarmesh::prediction
