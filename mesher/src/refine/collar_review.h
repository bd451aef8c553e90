#pragma once

#include <functional>
#include <optional>
#include <unordered_map>
#include <vector>

#include "refine/collar_surface.h"
#include "refine/work_queue.h"

namespace collarmesh {

/// Looks at the collar surface whenever everything else is done (paper, section 4), and queues what is poorly
/// represented: triangles, and vertices of creases that cells outside the collar have.
///
/// State: what is known of the collar surface since it looked last. Invariant, once started: every cell near
/// collars that was created since then, or whose vertices lie on other features, is touched; so it judges the
/// triangles around those alone, and those again whose candidates it gave away. So all looks together cost
/// what was created and what was given. The loop asks for looks, takes candidates, and tells of insertions
/// and of vertices that join features. What has no candidate is not asked again before its cells change: it
/// stays poor, for the certificate to tell.
class CollarReview {
 public:
  /// All are kept by reference. `stopped` is asked now and then. The first look tells the collars that no
  /// more balls will come.
  CollarReview(const RefinedMesh& mesh, CollarSystem& collars, CollarCells& cells,
               const RestrictedSurface& surface, const CollarCreator& creator, CollarSurface& collar_surface,
               WorkQueue& queue, std::function<bool()> stopped);

  /// Precondition: the queue is empty. False when nothing was queued: nothing is poor that can be mended, or
  /// nothing has come of what was queued before.
  bool check();
  /// What mends a queued triangle, or stands between a queued vertex and the cells outside. Nothing when that
  /// is impossible, or what was done meanwhile is to be looked at first.
  std::optional<Candidate> candidate(const WorkQueue::Item& item);

  void cells_made(const ConflictZone& zone);
  /// A vertex that is there was found to lie on a feature.
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
  bool changed_ = true;                 // since it looked last: vertices, or their features
  GrowingArray<std::uint8_t> touched_;  // by cell: a flag
  std::vector<Index> touched_cells_;    // each of them, and some that are gone or not touched any more
  CollarTriangles triangles_;
  std::vector<FaceId> poor_;                  // inside regions, to be looked at
  std::unordered_map<Index, Index> ball_at_;  // by the mesh vertices on creases
  std::vector<Index> exposed_;                // of these vertices, to be looked at
  std::vector<Index> scratch_;
};

}  // namespace collarmesh
