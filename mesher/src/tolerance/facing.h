#pragma once

#include <array>
#include <cmath>
#include <vector>

#include "collarmesh/plc.h"
#include "location/triangle_hierarchy.h"

namespace collarmesh {

std::vector<std::array<Index, 3>> corners_of_triangles(const Plc& plc);
/// Returns whether two patches are the same, or have a curve or a vertex in common.
bool are_neighbours(const Plc& plc, Index patch, Index other);
/// Returns the least cosine of the angle between a direction and a surface's normal at which the surface
/// faces that direction. It is larger between neighbouring patches, because they may form a wedge.
double least_facing(bool neighbours);

/// Returns the distance from a point x of a patch to the plane of a triangle, along a unit normal of the
/// patch; infinite if the triangle does not face the patch. Precondition: the ray from x in the direction
/// `way` (the normal or its opposite) crosses the triangle. Neighbouring patches face each other only if they
/// are almost parallel, because a wedge is no gap.
double facing_distance(const Plc& plc, Index patch, const Point& x, const Vector& normal, const Vector& way,
                       Index triangle, const std::array<Point, 3>& corners);

/// A search for the surface that faces a point of the surface, across a region, a gap or a cavity.
class FacingSurfaces {
 public:
  /// Keeps the complex by reference.
  explicit FacingSurfaces(const Plc& plc);

  struct Facing {
    double distance = INFINITY;
    Index triangle = none;
  };
  /// Scratch space of a thread.
  using Crossings = std::vector<TriangleHierarchy::Crossing>;

  /// Finds the surface that faces a point x of a triangle on side 0 (behind) or 1 (in front) of its patch, at
  /// a distance of at most `widest`.
  Facing from(const Point& x, Index triangle, unsigned side, double widest, Crossings& crossings) const;

  const TriangleHierarchy& triangles() const { return triangles_; }

 private:
  const Plc& plc_;
  TriangleHierarchy triangles_;
};

}  // namespace collarmesh
