#pragma once

#include <vector>

#include "refine/rip_and_stitch.h"
#include "refine/surface_check.h"

namespace collarmesh {

/// Looks at the topology of the surface as it is extracted, restricted and stitched triangles together: along
/// its curves each patch has as many triangles as the complex, elsewhere two at each edge; those at a vertex
/// hang together; and the vertices lie on their patches. Sheets of a smooth patch that are closer than the
/// distance tolerance miss that at first, because triangles may lead from one to the other: these are split.
///
/// State: what the complex has along its curves. The loop asks in the end.
class SurfaceTopology {
 public:
  /// All are kept by reference.
  SurfaceTopology(const Domain& domain, const RefinedMesh& mesh, const CollarCells& collar_cells,
                  const RestrictedSurface& surface, const CurveChains& curves, const RipAndStitch& stitching,
                  TriangleQuality& triangles, SurfaceCheck& surface_check)
      : domain_(domain),
        mesh_(mesh),
        collar_cells_(collar_cells),
        surface_(surface),
        curves_(curves),
        stitching_(stitching),
        triangles_(triangles),
        surface_check_(surface_check) {}

  /// Precondition: the collars are stitched. False when nothing was queued.
  bool check();

 private:
  void count_curve_sides();
  std::size_t sides_at(Index curve, Index patch) const;

  const Domain& domain_;
  const RefinedMesh& mesh_;
  const CollarCells& collar_cells_;
  const RestrictedSurface& surface_;
  const CurveChains& curves_;
  const RipAndStitch& stitching_;
  TriangleQuality& triangles_;
  SurfaceCheck& surface_check_;
  std::vector<std::vector<Index>> curve_sides_;  // by curve: triangles of each of its patches
};

}  // namespace collarmesh
