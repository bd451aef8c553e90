#pragma once

#include <optional>
#include <vector>

#include "refine/candidate.h"
#include "refine/facing_sheets.h"
#include "refine/graded_sizes.h"
#include "refine/random_offsets.h"
#include "refine/restricted_surface.h"
#include "refine/work_queue.h"

namespace collarmesh {

/// Which restricted triangles are to be destroyed: unresolved ones, whose vertices lie elsewhere, whose dual
/// edge crosses several sheets or whose circumcentre is too far from the surface; and large ones. (The first
/// two are found by RestrictedSurface::restrict_face, when the record is made.)
///
/// State: the notes of the restricted surface. Invariant: after an insertion every triangle of the new cells
/// is judged, and those that are to be destroyed are in the queue. The loop and BlockRefinement tell of
/// insertions and take candidates; SurfaceCheck and SurfaceTopology ask for triangles that are to be split.
class TriangleQuality {
 public:
  /// All are kept by reference.
  TriangleQuality(const Domain& domain, const RefinedMesh& mesh, const SurfaceNodes& nodes,
                  RestrictedSurface& surface, GradedSizes& sizes, FacingSheets& facing_sheets,
                  RandomOffsets& random, WorkQueue& queue)
      : domain_(domain),
        mesh_(mesh),
        nodes_(nodes),
        surface_(surface),
        sizes_(sizes),
        facing_sheets_(facing_sheets),
        random_(random),
        queue_(queue) {}

  /// Paper, Procedure 2: the triangle whose surface gap ball a candidate with this zone lies deepest in;
  /// no_face when it encroaches none.
  FaceId encroached(const ConflictZone& zone, const Candidate& candidate) const;
  /// What destroys a triangle, if anything can.
  std::optional<Candidate> candidate(FaceId face);
  /// The same, if no vertex of the triangle lies on another sheet and a cell beside it is in conflict with
  /// the candidate; else nothing, and only the loop can tell. Several threads may ask at once, each with
  /// offsets of its own, of triangles in its own block.
  std::optional<Candidate> candidate_beside(FaceId face, RandomOffsets& random) const;
  /// Is the entry of the queue that of a triangle that is to be destroyed?
  bool due(const WorkQueue::Entry& entry) const;
  /// Queues a triangle again that is still there after something else was inserted in its place.
  void queue_again(const WorkQueue::Item& item, double squared_radius);
  /// Nothing could be inserted to destroy a triangle: nothing more is tried.
  void give_up(FaceId face) { surface_.notes(face).given_up = true; }

  /// Precondition: surface and sizes know the new cells and the vertex.
  void cells_made(const ConflictZone& zone);
  /// The same for a zone in a block. Several threads may tell, each with a queue of its own, as long as no
  /// size is asked of the caller or kept at vertices.
  void cells_made(const ConflictZone& zone, WorkQueue& queue) const;
  /// Sizes have changed everywhere.
  void judge_all();
  /// Queues a triangle that is to be split for the sake of its patch, unless it was given up: even one in a
  /// collar.
  void split(FaceId face);

 private:
  void judge(FaceId face);
  template <class TargetSize>
  void judge(FaceId face, WorkQueue& queue, const TargetSize& target_size) const;
  Point place(FaceId face, RandomOffsets& random) const;
  bool has_vertex_on_another_sheet(FaceId face) const;
  double target_size(FaceId face, const RestrictedTriangle& t);
  double gap_at(const RestrictedTriangle& t, double widest);
  bool too_far(FaceId face, const RestrictedTriangle& t) const;
  WorkQueue::Entry entry(FaceId face) const { return {face, mesh_.generation(cell_of(face))}; }

  const Domain& domain_;
  const RefinedMesh& mesh_;
  const SurfaceNodes& nodes_;
  RestrictedSurface& surface_;
  GradedSizes& sizes_;
  FacingSheets& facing_sheets_;
  RandomOffsets& random_;
  WorkQueue& queue_;
  std::vector<TriangleHierarchy::Crossing> crossings_;  // scratch
};

}  // namespace collarmesh
