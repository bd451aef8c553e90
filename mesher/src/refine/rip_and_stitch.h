#pragma once

#include <vector>

#include "refine/collar_surface.h"
#include "refine/curve_chains.h"

namespace collarmesh {

/// The tets that replace the cells inside the collars, with mesh vertices as corners.
struct Stitched {
  struct Tet {
    std::array<Index, 4> corners;
    Index region;
    std::uint8_t collar;  ///< 1 star, 2 book
    Tag crease;           ///< tag of the crease's curve or vertex
  };
  struct Face {
    std::array<Index, 3> corners;
    std::array<Index, 2> regions;
    Index patch;
  };
  struct Edge {
    std::array<Index, 2> corners;
    Index curve;
  };
  std::vector<Tet> tets;
  std::vector<Face> faces;
  std::vector<Edge> edges;
  std::vector<Index> open;  ///< mesh vertices of faces on no patch that separate regions or have more than
                            ///< two tets; and a corner of each tet left out because two corners are equal
};

/// Rip and stitch (paper, Procedure 5). `extract` drops the cells inside the collars, and this class makes
/// the tets that replace them: each triangle of the collar surface makes a star tet with its ball's centre,
/// each edge between triangles of consecutive balls a book tet with the two centres.
/// State: the result of the last `stitch`, which the loop calls. SurfaceTopology and `extract` read it.
class RipAndStitch {
 public:
  /// Keeps all by reference.
  RipAndStitch(const Domain& domain, const RefinedMesh& mesh, const SurfaceNodes& nodes,
               const CollarSystem& collars, const RestrictedSurface& surface, const UnresolvedPoints& points,
               const CurveChains& curves, const CollarCreator& creator, CollarSurface& collar_surface)
      : domain_(domain),
        mesh_(mesh),
        nodes_(nodes),
        collars_(collars),
        surface_(surface),
        points_(points),
        curves_(curves),
        creator_(creator),
        collar_surface_(collar_surface) {}

  /// Makes the tets. Precondition: every point is resolved, unless refinement has given up. If it has, the
  /// collar surface may not be well represented; then some collars are `open` or have cells other than the
  /// paper's.
  void stitch();
  const Stitched& result() const { return stitched_; }

 private:
  void add(const Stitched::Tet& tet);
  Tag crease_tag(Index ball) const;
  void stitch_books(const std::vector<CollarTriangle>& triangles);
  void stitch_faces(const std::vector<CollarTriangle>& triangles);
  Index patch_between(const std::array<Index, 3>& corners, Index a, Index b) const;
  bool lies_on(const std::array<Index, 3>& face, Index patch) const;
  bool against_patch(const std::array<Index, 3>& face, Index patch) const;
  Point centroid(const std::array<Index, 3>& face) const;

  const Domain& domain_;
  const RefinedMesh& mesh_;
  const SurfaceNodes& nodes_;
  const CollarSystem& collars_;
  const RestrictedSurface& surface_;
  const UnresolvedPoints& points_;
  const CurveChains& curves_;
  const CollarCreator& creator_;
  CollarSurface& collar_surface_;
  Stitched stitched_;
};

}  // namespace collarmesh
