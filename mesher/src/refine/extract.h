#pragma once

#include "collarmesh/tet_mesh.h"
#include "common/known_neighbours.h"
#include "refine/rip_and_stitch.h"

namespace collarmesh {

/// The parts from which the result is made.
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
  KnownNeighbours neighbours;  ///< `none` at all sides of stitched tets
};

/// Returns the result of the refinement: the cells inside regions and outside collars, and the stitched tets.
/// Points are in the order of a space-filling curve, tets and faces in the order of their smallest point
/// numbers, so that a loop over them finds neighbouring data in the caches.
Extracted extract(const Refined& refined);

}  // namespace collarmesh
