#pragma once

#include <array>
#include <optional>
#include <vector>

#include "collarmesh/plc.h"
#include "collarmesh/progress.h"
#include "collarmesh/surface_tolerance.h"
#include "collarmesh/tet_mesh.h"
#include "constrained/rods.h"

namespace collarmesh {

/// A rod inside another region, with tetrahedra in the rod and in a sheath around it. On the outside of
/// the sheath, edges along and around the rod are at most about five radii of the rod long.
struct SheathedRod {
  /// An end of the rod on a planar patch of the region around it.
  struct End {
    Index patch, curve;
    Index host;              ///< the patch of the region around the rod, in the same plane
    std::vector<Index> rim;  ///< the border of the sheath in that plane, in order
  };

  TetMesh mesh;  ///< the tets of the rod and of its sheath, their faces on patches and edges on curves
  std::vector<Index> fixed;                ///< the vertices of the rod without its sheath
  Index region = 0;                        ///< the rod
  Index around = 0;                        ///< the region around it
  Index patch = none;                      ///< the smooth patch between them
  std::vector<End> ends;                   ///< two, or none for a closed rod
  std::vector<std::array<Index, 3>> skin;  ///< the outside of the sheath, with normals away from the rod
  double reach = 0;                        ///< largest distance of the sheath from the axis
  std::vector<Point> axis;   ///< the axis from end to end; that of a closed rod repeats its first point
  std::vector<Point> seeds;  ///< points on the axis, about twice the reach apart
};

/// Returns the thin rods of a complex that lie in another region, which alone surrounds them: closed rods,
/// and straight or bent rods both of whose ends lie in planar patches on the outside of that region. Leaves
/// out rods that bend sharply, whose rings cannot keep the tolerance, or whose sheaths are wider than the
/// size. Returns none if they would take too many vertices or if cancelled.
std::vector<SheathedRod> sheathed_rods(const Plc& plc, const SurfaceTolerance& tolerance,
                                       const RodLimits& limits, const Execution& execution = {});

}  // namespace collarmesh
