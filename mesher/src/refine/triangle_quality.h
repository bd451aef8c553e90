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

/// The part that decides which restricted triangles to destroy: large ones and unresolved ones. A triangle is
/// unresolved if its vertices do not all lie on its patch, if its dual edge crosses several sheets, or if its
/// circumcentre is too far from the surface. (RestrictedSurface::restrict_face finds the first two when it
/// makes the record.)
/// State: the notes of the restricted surface. Invariant: after an insertion every triangle of the new cells
/// is judged, and the queue contains those that must be destroyed. The loop and BlockRefinement report
/// insertions and take candidates; SurfaceCheck and SurfaceTopology ask for triangles to split.
class TriangleQuality {
 public:
  /// Keeps all by reference.
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

  /// Returns the triangle in whose surface gap ball a candidate with this zone lies deepest (paper, Procedure
  /// 2); no_face if it encroaches none.
  FaceId encroached(const ConflictZone& zone, const Candidate& candidate) const;
  /// Returns a candidate that destroys a triangle, if there is one.
  std::optional<Candidate> candidate(FaceId face);
  /// Returns a candidate that destroys a triangle if no vertex of the triangle lies on another sheet and a
  /// cell beside it is in conflict with the candidate. Otherwise returns nothing; then the loop must handle
  /// the triangle. Several threads may call it at once, each with its own offsets and for triangles in its
  /// own block.
  std::optional<Candidate> candidate_beside(FaceId face, RandomOffsets& random) const;
  /// Returns whether the triangle of a queue entry must still be destroyed.
  bool is_due(const WorkQueue::Entry& entry) const;
  /// Queues a triangle again if it still exists after another insertion.
  void queue_again(const WorkQueue::Item& item, double squared_radius);
  /// Records that no point could be inserted to destroy a triangle, so that it is not tried again.
  void give_up(FaceId face) { surface_.note_given_up(face); }

  /// Judges the triangles of new cells. Precondition: the new cells and the vertex were reported to surface
  /// and sizes.
  void cells_made(const ConflictZone& zone);
  /// Judges the triangles of new cells in a block. Several threads may call it, each with its own queue, if
  /// the caller gives no size field and no sizes are kept at vertices.
  void cells_made(const ConflictZone& zone, WorkQueue& queue) const;
  /// Judges all triangles because sizes have changed everywhere.
  void judge_all();
  /// Queues a triangle that must be split for the sake of its patch, even in a collar, unless it was given
  /// up.
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
