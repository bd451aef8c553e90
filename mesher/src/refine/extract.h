#pragma once

#include "collarmesh/tet_mesh.h"
#include "refine/rip_and_stitch.h"

namespace collarmesh {

/// What of the parts makes the result.
struct Refined {
  const Domain& domain;
  const RefinedMesh& mesh;
  const SurfaceNodes& nodes;
  const CollarSystem& collars;
  const CollarCells& collar_cells;
  const RestrictedSurface& surface;
  const CurveChains& curves;
  const CollarCreator& creator;
  const Stitched& stitched;
};

/// The result of the refinement: the cells inside regions and outside collars, and what was stitched.
TetMesh extract(const Refined& refined);

}  // namespace collarmesh
