#pragma once

#include <vector>

#include "refine/collar_cells.h"
#include "refine/curve_chains.h"
#include "refine/outcome.h"
#include "refine/triangle_quality.h"
#include "refine/unresolved_points.h"

namespace collarmesh {

/// Returns at most `count` candidates that are far from each other: chooses each as the candidate farthest
/// from those chosen before. Cost: candidates times count.
std::vector<Index> spread_points(std::span<const Index> candidates, const std::vector<Point>& points,
                                 std::size_t count);

/// The part that checks the whole restricted surface when the queue is empty: whether the triangles of each
/// patch form a manifold that ends at the patch's curves, whether any part of a smooth patch was missed, and
/// whether cells are flat. Queues every violation found.
///
/// State: for each corner and centre of the triangles of smooth patches, the mesh face that it was near to at
/// the last check, so that a round only tests what has changed; the number of rounds. The loop calls it.
class SurfaceCheck {
 public:
  /// Keeps all by reference.
  SurfaceCheck(const Domain& domain, const RefinedMesh& mesh, const SurfaceNodes& nodes,
               const CollarSystem& collars, const CollarCells& collar_cells, RestrictedSurface& surface,
               TriangleQuality& triangles, UnresolvedPoints& points, CurveChains& curves, Outcome& outcome)
      : domain_(domain),
        mesh_(mesh),
        nodes_(nodes),
        collars_(collars),
        collar_cells_(collar_cells),
        surface_(surface),
        triangles_(triangles),
        points_(points),
        curves_(curves),
        outcome_(outcome) {}

  /// Seeds closed patches: refinement has no border to start from there.
  void seed_closed_patches();
  /// Runs a round. Returns false if it found nothing wrong or has given up.
  bool check();
  /// Counts a round that found a violation. After too many rounds, gives up and returns false.
  bool another_round();
  /// Gives flat cells at the boundary of the domain to the outside. Precondition: refinement is over. Returns
  /// false if there are none.
  bool relabel_flat_cells();

 private:
  /// A point at which the certificate tests a smooth patch, outside collars: a corner or the centre of a
  /// triangle of the complex. Stores a face of the mesh that it was near to.
  struct TessellationPoint {
    Point at;
    double tolerance;
    FaceId near = no_face;
    std::uint32_t generation = 0;  // generation of the face's cell
  };
  std::vector<bool> vertices_at_collars() const;
  bool check_patch_topology(const std::vector<FaceId>& faces);
  bool is_near_patch(const Point& p, Index patch, Index& near) const;
  bool refine_distant_triangles(const std::vector<FaceId>& faces);
  void seed_missed_patch(Index patch);
  void seed(Index patch, const Point& at);
  void prepare_tessellation();
  bool still_near(const TessellationPoint& p, Index patch) const;
  bool resolve_distant_points(const std::vector<FaceId>& faces);
  void resolve(const TessellationPoint& p, Index patch, FaceId nearest);
  std::vector<Index> cells_on_surface() const;
  bool flat_on_patch(Index cell) const;
  bool has_no_volume(Index cell) const;
  bool at_boundary(FaceId face) const;
  bool check_flat_cells();

  const Domain& domain_;
  const RefinedMesh& mesh_;
  const SurfaceNodes& nodes_;
  const CollarSystem& collars_;
  const CollarCells& collar_cells_;
  RestrictedSurface& surface_;
  TriangleQuality& triangles_;
  UnresolvedPoints& points_;
  CurveChains& curves_;
  Outcome& outcome_;
  std::vector<TessellationPoint> tessellation_;        // points of all smooth patches, one after the other
  std::vector<std::size_t> first_tessellation_point_;  // by patch; empty before the first check
  unsigned rounds_ = 0;
};

}  // namespace collarmesh
