#pragma once

#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "collarmesh/plc.h"
#include "collarmesh/surface_tolerance.h"
#include "location/triangle_hierarchy.h"
#include "shells/triangle_shape.h"

namespace collarmesh::shells {

/// The patches of a complex as surfaces: finds nearest places and normals, and judges how well triangles fit.
class PatchSurfaces {
 public:
  /// Keeps the complex by reference. Cost: linear.
  PatchSurfaces(const Plc& plc, SurfaceTolerance tolerance);

  struct Foot {
    Point point;
    Vector normal;   ///< unit normal, interpolated between the patch's points
    Index triangle;  ///< triangle of the complex
    double distance;
    double tolerance;  ///< tolerance at this place
  };
  /// Returns the place of a patch that is nearest to p.
  Foot nearest(Index patch, const Point& p) const;
  bool planar(Index patch) const { return plc_.patches[patch].planar; }

  /// Returns the place of a planar patch's plane that is nearest to p.
  Point onto_plane(Index patch, const Point& p) const {
    const Point& origin = plc_.points[plc_.triangles[plc_.patches[patch].first_triangle].points[0]];
    return p - dot(p - origin, normals_[patch]) * normals_[patch];
  }

  /// Returns the cosine of the angle between the triangle's normal and the patch's normal nearest to the
  /// triangle's centre; -1 for a triangle without area.
  double agreement(const Corners& t, Index patch) const;
  /// The quality of a triangle's fit to a patch.
  struct Fit {
    double agreement = 1;  ///< see `agreement`
    double excess = 0;  ///< distance of the triangle's centre from the patch, divided by the tolerance there
  };
  /// Returns the fit of a triangle. An excess below `enough` need not be exact: it may be overestimated, up
  /// to `enough`.
  Fit fit(const Corners& t, Index patch, double enough = 0) const;
  /// Measures the distances of the points at one and two thirds of the segment ab from the patch, divides
  /// them by the tolerances there, and returns the larger quotient. `enough`: as for `fit`.
  double excess_between(Index patch, const Point& a, const Point& b, double enough) const;
  /// Returns points of a smooth patch that are farther from all of `triangles` than this share of the
  /// tolerance, each with the index of the nearest triangle; at most one point per triangle.
  std::vector<std::pair<Index, Point>> far_points(Index patch, std::span<const Corners> triangles,
                                                  double share) const;

 private:
  const TriangleHierarchy& hierarchy(Index patch) const;
  Index triangle_near(Index patch, const Point& p, double enough) const;
  Foot foot_on(Index patch, Index triangle, const Point& p) const;
  Vector normal_at(Index patch, Index triangle, const Point& p) const;
  void find_normals(Index patch);

  const Plc& plc_;
  SurfaceTolerance tolerance_;
  std::vector<Vector> normals_;                    // by patch, unit vectors
  std::vector<std::array<Vector, 3>> at_corners_;  // by triangle and corner
  mutable std::vector<std::unique_ptr<TriangleHierarchy>> hierarchies_;
  mutable std::vector<Index> last_found_;  // by patch: the last triangle found, because the next place is
                                           // probably near it
  std::vector<double> least_tolerance_;    // by patch
};

}  // namespace collarmesh::shells
