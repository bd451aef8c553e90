#pragma once

#include <array>
#include <span>
#include <vector>

#include "collarmesh/geometry.h"
#include "common/spatial_order.h"

namespace collarmesh::repairing {

/// A triangle that counts a number of times; negative: with opposite orientation.
struct WeightedTriangle {
  std::array<Point, 3> corners;
  int weight = 1;
  Index number = 0;  ///< number by which it can be left out
};

/// The generalized winding number of triangles around points (Jacobson, Kavan, Sorkine-Hornung 2013), with
/// far ones taken together as in Barill, Dickson, Schmidt, Levin, Jacobson 2018: 1 inside a closed surface
/// that is oriented outwards, 0 outside, and in between where a surface is open.
class WindingNumber {
 public:
  /// Builds the hierarchy. Cost: O(n).
  explicit WindingNumber(std::vector<WeightedTriangle> triangles);

  /// Returns the number at a point, without the triangles of this number. On a triangle that is left out this
  /// is the mean of its two sides. Cost: O(log n) for a surface that is not folded up around the point.
  double at(const Point& p, Index left_out = none) const;

  /// Returns whether the point is so close to another triangle that only rounding decides on which side of it
  /// the point lies.
  bool is_on_another(const Point& p, Index left_out) const;

 private:
  struct Node {
    Point centre;                  // weighted by area
    double radius;                 // radius of the ball around the centre that contains all corners
    Vector area;                   // sum of weight * area vectors
    std::array<double, 9> moment;  // sum of weight * (centroid - centre) x area vector, as a matrix
    Index first, count;            // triangles of a leaf; count 0: the children are the next node and `first`
  };
  static constexpr Index leaf_size = 8;

  Index build(std::span<const SpatialKey> keys, Index first);
  Node summary(Index first, Index count) const;
  double at_node(Index node, const Point& p, Index left_out) const;
  bool is_on_another(Index node, const Point& p, Index left_out) const;

  std::vector<WeightedTriangle> triangles_;  // in the order of the leaves
  std::vector<Node> nodes_;
};

}  // namespace collarmesh::repairing
