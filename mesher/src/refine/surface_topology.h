#pragma once

#include <vector>

#include "refine/rip_and_stitch.h"
#include "refine/surface_check.h"

namespace collarmesh {

/// The part that checks the topology of the surface as it is extracted, with restricted and stitched
/// triangles: along its curves each patch has as many triangles as in the complex; each other edge has two;
/// the triangles at a vertex are connected; the vertices lie on their patches. Sheets of a smooth patch that
/// are closer than the distance tolerance violate this at first, because triangles may lead from one sheet to
/// the other. Such triangles are split.
/// State: how many triangles of each patch meet at each curve of the complex. The loop calls it at the end.
class SurfaceTopology {
 public:
  /// Keeps all by reference.
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

  /// Checks the surface and queues triangles to split. Returns false if it queued none or has given up.
  /// Precondition: the collars are stitched.
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
  std::vector<std::vector<Index>> curve_sides_;  // by curve and its patches: number of triangles at a segment
};

}  // namespace collarmesh
