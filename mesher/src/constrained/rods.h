#pragma once

#include <cstddef>
#include <optional>

#include "collarmesh/plc.h"
#include "collarmesh/progress.h"
#include "collarmesh/surface_tolerance.h"
#include "collarmesh/tet_mesh.h"

namespace collarmesh {

struct RodLimits {
  double size;                    ///< target edge length
  std::size_t most_vertices = 0;  ///< 0: any number
};

/// Returns tetrahedra of a complex all of whose bodies are thin rods: straight or bent bodies of round
/// section that one smooth patch and two planar ends bound, or one smooth patch alone, as a ring. Returns
/// nothing for other complexes, and if no ring of vertices around a rod keeps the tolerance. Rings of
/// vertices lie on the patch, some radii apart but not farther than the size, with a vertex on the axis
/// between neighbouring rings. This takes few tets, which have good angles. Rods are thin if their radius is
/// at most half of the size and their length at least eight radii. Returns nothing, too, if there would be
/// too many vertices or if cancelled. Cost: near linear in the triangles plus the length of rods in radii.
std::optional<TetMesh> tetrahedra_of_rods(const Plc& plc, const SurfaceTolerance& tolerance,
                                          const RodLimits& limits, const Execution& execution = {});

}  // namespace collarmesh
