#pragma once

#include <vector>

#include "collarmesh/mesher.h"
#include "common/patch_points.h"
#include "location/curve_paths.h"
#include "refine/frame.h"

namespace collarmesh {

/// What is to be meshed, and how closely. Fixed from the start; every part reads it.
struct Domain {
  /// The complex is kept by reference.
  Domain(const Plc& complex, const MeshOptions& mesh_options);
  Domain(const Domain&) = delete;
  Domain& operator=(const Domain&) = delete;

  /// Is it to be meshed exactly as the paper's proofs assume?
  bool is_papers() const { return options.profile == Profile::paper; }
  /// The radius of the smallest ball that is destroyed at a place: it ends what would never end. It is
  /// `floor` or, where edges of the complex are tiny, a share of the shortest one that is near.
  double floor_at(const Point& p) const;
  /// Is a ball around this place too small to be destroyed?
  bool at_floor(const Point& p, double squared_radius) const {
    if (squared_radius >= floor * floor) return false;
    const double least = floor_at(p);
    return squared_radius < least * least;
  }
  /// The nearest point in the plane of a planar patch.
  Point on_plane(Index patch, const Point& p) const;
  /// Is a point strictly inside the box?
  bool in_box(const Point& p) const {
    return p.x > box.min.x && p.x < box.max.x && p.y > box.min.y && p.y < box.max.y && p.z > box.min.z &&
           p.z < box.max.z;
  }

  const Plc& plc;
  const MeshOptions options;
  const Frame frame;
  const std::vector<Point> points;  ///< of the complex, in the frame
  const PatchPoints patch_points;
  const CurvePaths paths;
  const double diagonal;             ///< of the complex; lengths here are absolute
  const SurfaceTolerance tolerance;  ///< how far the mesh may be from smooth curves and patches
  const double floor;                ///< least radius of balls that are destroyed, but at tiny edges
  const Box box;                     ///< around the mesh, well away from the complex; in the frame

 private:
  struct TinyEdge {
    Point middle;
    double length;
  };
  std::vector<TinyEdge> tiny_edges() const;

  const std::vector<TinyEdge> tiny_edges_;
};

}  // namespace collarmesh
