#pragma once

#include <array>
#include <span>
#include <vector>

#include "collarmesh/geometry.h"
#include "common/hierarchy.h"

namespace collarmesh::repairing {

/// A triangle with a multiplicity, which is negative for the opposite orientation.
struct WeightedTriangle {
  std::array<Point, 3> corners;
  int weight = 1;
  Index number = 0;  ///< number by which queries can leave it out
};

/// The generalized winding number of triangles around points (Jacobson, Kavan, Sorkine-Hornung 2013): 1
/// inside a closed surface that is oriented outwards, 0 outside, and in between if a surface is open. Distant
/// triangles are taken together as in Barill, Dickson, Schmidt, Levin, Jacobson 2018.
class WindingNumber {
 public:
  /// Builds the hierarchy. Cost: O(n).
  explicit WindingNumber(std::vector<WeightedTriangle> triangles);

  /// Returns the winding number at a point, leaving out triangles with the number `left_out`. At a point on a
  /// triangle that is left out, the result is the mean of the winding numbers on the triangle's two sides.
  /// Cost: O(log n) unless the surface is crumpled around the point; with a number that several triangles
  /// have, also linear in the triangles among which these lie scattered.
  double at(const Point& p, Index left_out = none) const;

  /// Returns whether the point is so close to a triangle with another number than `left_out` that rounding
  /// alone decides on which side it lies.
  bool is_on_another(const Point& p, Index left_out) const;

 private:
  /// Consecutive triangles.
  struct Range {
    const std::vector<WeightedTriangle>& triangles;
    Index first, count;
  };
  struct Summary {
    Point centre;       // centroid of the triangles, weighted by area
    double radius = 0;  // radius of the smallest ball around the centre that contains all corners
    Vector area{};      // sum of weight * area vectors
    std::array<double, 9> moment{};  // sum of weight * (centroid - centre) * (area vector)^T, row by row
    Index least_number = none, greatest_number = 0;

    Summary() = default;
    explicit Summary(const Range& range);
  };

  double at_node(Index node, const Point& p, Index left_out) const;
  bool is_on_another(Index node, const Point& p, Index left_out) const;
  /// Returns whether some triangles of a node, far from p, may have to be left out.
  bool may_leave_out(const Summary& node, Index left_out) const {
    return numbers_are_shared_ && node.least_number <= left_out && left_out <= node.greatest_number;
  }

  std::vector<WeightedTriangle> triangles_;  // in the order of the leaves
  bool numbers_are_shared_ = false;  // whether several triangles have the same number; else a triangle that
                                     // is left out is the one that the point lies on, and thus near
  Hierarchy<Summary> tree_;
};

}  // namespace collarmesh::repairing
