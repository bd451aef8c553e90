#pragma once

#include <vector>

#include "collarmesh/mesher.h"
#include "common/patch_points.h"
#include "location/curve_paths.h"
#include "refine/frame.h"

namespace collarmesh {

/// The complex to mesh, and the required accuracy. Constant from the start; every part reads it.
struct Domain {
  /// Keeps the complex by reference.
  Domain(const Plc& complex, const MeshOptions& mesh_options);
  Domain(const Domain&) = delete;
  Domain& operator=(const Domain&) = delete;

  /// Returns whether the mesh must meet exactly the assumptions of the paper's proofs.
  bool is_papers() const { return options.profile == Profile::paper; }
  /// Returns the radius of the smallest ball that may be destroyed at a place; it stops refinement that would
  /// not terminate. It is `floor` or, near tiny edges of the complex, a share of the length of the shortest
  /// of these, as far as double precision permits.
  double floor_at(const Point& p) const;
  /// Returns whether a ball around this place is too small to be destroyed.
  bool at_floor(const Point& p, double squared_radius) const {
    if (squared_radius >= floor * floor) return false;
    const double least = floor_at(p);
    return squared_radius < least * least;
  }
  /// Returns the nearest point in the plane of a planar patch.
  Point on_plane(Index patch, const Point& p) const;
  /// Returns whether a point is strictly inside the box.
  bool in_box(const Point& p) const {
    return p.x > box.min.x && p.x < box.max.x && p.y > box.min.y && p.y < box.max.y && p.z > box.min.z &&
           p.z < box.max.z;
  }

  const Plc& plc;
  const MeshOptions options;
  const Frame frame;
  const std::vector<Point> points;  ///< points of the complex, in the frame
  const PatchPoints patch_points;
  const CurvePaths paths;
  const double diagonal;             ///< diagonal of the complex; lengths in this struct are absolute
  const SurfaceTolerance tolerance;  ///< at smooth curves and patches; a share of the options' tolerance
  const double floor;                ///< least radius of balls that are destroyed, except at tiny edges
  const Box box;                     ///< box around the mesh, well away from the complex; in the frame

 private:
  struct TinyEdge {
    Point middle;
    double length;
  };
  std::vector<TinyEdge> tiny_edges() const;

  const std::vector<TinyEdge> tiny_edges_;
};

}  // namespace collarmesh
