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
  const double floor;  ///< no ball with a smaller radius is destroyed: it ends what would never end
  const Box box;       ///< around the mesh, well away from the complex; in the frame
};

}  // namespace collarmesh
