#pragma once

#include <functional>
#include <optional>
#include <unordered_map>
#include <utility>
#include <vector>

#include "refine/collar_surface.h"
#include "refine/work_queue.h"

namespace collarmesh {

/// The part that reviews the collar surface whenever all other work is done (paper, section 4), and queues
/// its faults: poor triangles, and exposed vertices, that is, mesh vertices on creases that are corners of
/// cells outside the collars.
///
/// State: the triangles of the collar surface as reviews have judged them, and the cells touched since the
/// last review. Invariant, once started: a cell near collars is touched if it was created since the last
/// review, or if one of its vertices has joined a feature since then. So a review only judges the triangles
/// around touched cells, and triangles whose candidates it has handed out; the cost of all reviews together
/// is proportional to the created cells and the candidates. The loop asks for reviews, takes candidates, and
/// reports insertions and vertices that join features. A fault without a candidate is not reviewed again
/// before its cells change: it stays, and the certificate reports it.
class CollarReview {
 public:
  /// Keeps references to all arguments. Calls `stopped` now and then. The first review completes the system
  /// of collars; after it no balls may be added.
  CollarReview(const RefinedMesh& mesh, CollarSystem& collars, CollarCells& cells,
               const RestrictedSurface& surface, const CollarCreator& creator, CollarSurface& collar_surface,
               WorkQueue& queue, std::function<bool()> stopped)
      : mesh_(mesh),
        collars_(collars),
        cells_(cells),
        surface_(surface),
        creator_(creator),
        collar_surface_(collar_surface),
        queue_(queue),
        stopped_(std::move(stopped)) {}

  /// Reviews the surface. Returns false if nothing was queued: no fault is left to repair, the items
  /// queued last changed nothing, or the refinement was stopped. Precondition: the queue is empty.
  bool check();
  /// Returns the point to insert for this queue item: it repairs a poor triangle or shields an exposed crease
  /// vertex. Returns nothing if there is no such point, or if recent changes must be reviewed first.
  std::optional<Candidate> candidate(const WorkQueue::Item& item);

  void cells_made(const ConflictZone& zone);
  /// Reports that an existing vertex lies on a feature.
  void vertex_joined_feature(Index vertex);

  std::size_t bytes() const { return triangles_.bytes() + touched_.bytes(); }

 private:
  void start();
  void touch(Index cell);
  std::vector<Index> take_touched();
  void take_in_flat_cells(std::vector<Index>& cells);
  Index ball_to_take_in(Index cell);
  bool judge_changed_triangles(const std::vector<Index>& cells);
  const CollarTriangle* known_triangle(FaceId face) const;
  bool poor_edge(const CollarTriangle& t, Index a, Index b) const;
  void find_exposed_vertices(const std::vector<Index>& cells);
  const std::vector<Index>& cells_outside(Index vertex);
  void queue_exposed_vertices();
  void queue_poor_triangles();
  std::optional<Candidate> candidate_at_vertex(Index vertex);
  std::optional<Candidate> candidate_towards(Index outside, Index vertex) const;
  std::optional<Candidate> candidate_on_triangle(const WorkQueue::Entry& entry);

  const RefinedMesh& mesh_;
  CollarSystem& collars_;
  CollarCells& cells_;
  const RestrictedSurface& surface_;
  const CollarCreator& creator_;
  CollarSurface& collar_surface_;
  WorkQueue& queue_;
  std::function<bool()> stopped_;

  bool started_ = false;
  bool changed_ = true;                 // vertices or their features have changed since the last review
  GrowingArray<std::uint8_t> touched_;  // by cell: a flag
  std::vector<Index> touched_cells_;    // the touched cells, and some that no longer exist or no longer are
                                        // touched
  CollarTriangles triangles_;
  std::vector<FaceId> poor_;                  // poor triangles to queue; their outer cells lie in regions
  std::unordered_map<Index, Index> ball_at_;  // by mesh vertex on a crease: a ball that contains it
  std::vector<Index> exposed_;                // mesh vertices on creases, to queue if exposed
  std::vector<Index> scratch_;
};

}  // namespace collarmesh
