#pragma once

#include "collarmesh/tet_mesh.h"
#include "common/known_neighbours.h"
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

struct Extracted {
  TetMesh mesh;
  KnownNeighbours neighbours;  ///< none at all sides of stitched tets
};

/// The result of the refinement: the cells inside regions and outside collars, and what was stitched. In
/// memory points lie along a curve through space, tets and faces in the order of their least points: what
/// visits them one after the other finds their neighbourhood in the caches.
Extracted extract(const Refined& refined);

}  // namespace collarmesh
