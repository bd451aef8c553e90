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
  /// Cost: O(log n) unless the surface is crumpled around the point; also grows with the number of distant
  /// triangles that are left out and have others near them.
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
    Index first = 0, end = 0;        // the triangles

    Summary() = default;
    explicit Summary(const Range& range);
  };

  /// The number of a triangle, and its place in `triangles_`.
  struct Numbered {
    Index number, place;
  };

  double at_node(Index node, const Point& p, std::span<const Numbered> left_out) const;
  bool is_on_another(Index node, const Point& p, Index left_out) const;

  std::vector<WeightedTriangle> triangles_;  // in the order of the leaves
  std::vector<Numbered> numbered_;           // sorted by numbers, then by places
  Hierarchy<Summary> tree_;
};

}  // namespace collarmesh::repairing
