#pragma once

#include <optional>
#include <vector>

#include "common/growing_array.h"
#include "refine/candidate.h"
#include "refine/collar_cells.h"
#include "refine/facing_sheets.h"
#include "refine/graded_sizes.h"
#include "refine/random_offsets.h"
#include "refine/restricted_surface.h"
#include "refine/work_queue.h"

namespace collarmesh {

/// The part that decides which cells to destroy: skinny ones, by their radius-edge ratio or because they are
/// flat, and large ones.
///
/// State: if the options bound the vertex ratio, the shortest edge at every vertex. Invariant: after an
/// insertion the queue contains every new cell that must be destroyed, and every older cell that must be
/// destroyed because of the insertion. The loop reports insertions and takes candidates.
class CellQuality {
 public:
  /// Keeps all by reference.
  CellQuality(const Domain& domain, const RefinedMesh& mesh, const CollarCells& collar_cells,
              const RestrictedSurface& surface, const GradedSizes& sizes, const FacingSheets& facing_sheets,
              RandomOffsets& random, WorkQueue& queue)
      : domain_(domain),
        mesh_(mesh),
        collar_cells_(collar_cells),
        surface_(surface),
        sizes_(sizes),
        facing_sheets_(facing_sheets),
        random_(random),
        queue_(queue),
        leaves_narrow_cells_(domain.options.narrow_cells != NarrowCells::bounded) {
    if (domain_.options.vertex_ratio > 0) shortest_edge_.resize(mesh_.vertex_count(), INFINITY);
  }

  /// Returns a candidate that destroys a cell, if there is one. Not thread-safe.
  std::optional<Candidate> candidate(Index cell) { return candidate(cell, random_); }
  /// Returns a candidate that destroys a cell, if there is one. Several threads may call this at once, each
  /// with its own offsets and for cells of its own block.
  std::optional<Candidate> candidate(Index cell, RandomOffsets& random) const;
  /// Returns whether the cell of a queue entry still exists and is outside the collars. In the paper's
  /// profile skinny cells inside collars are due, too.
  bool is_due(const WorkQueue::Item& item) const {
    return mesh_.alive(item.entry.id, item.entry.stamp) &&
           (!collar_cells_.inside(item.entry.id) ||
            (domain_.is_papers() && item.priority == WorkQueue::skinny_cells));
  }
  /// Queues a cell again if it still exists after another insertion.
  void queue_again(const WorkQueue::Item& item, double squared_radius);

  /// Judges the new cells. Precondition: these cells were reported to surface, collar cells and sizes.
  void cells_made(const ConflictZone& zone, Index vertex);
  /// Queues a cell if it must be destroyed. Several threads may call it at once, each with its own queue, if
  /// there is no vertex ratio, the caller gives no size field, and no sizes are kept at vertices.
  void judge(Index cell, WorkQueue& queue) const { judge(cell, queue, leaves_narrow_cells_); }
  /// Judges all cells: at the start, and when sizes have changed everywhere.
  void judge_all();
  /// Makes narrow cells keep the radius-edge bound, too, from now on. Queues those that exceed it and returns
  /// whether there are any. Further calls do nothing and return false.
  bool bound_narrow_cells();

  std::size_t bytes() const { return shortest_edge_.bytes(); }

 private:
  void judge(Index cell, WorkQueue& queue, bool leaves_narrow_cells) const;
  void judge_in_collar(Index cell, WorkQueue& queue) const;
  bool is_narrow(Index cell, Index region) const;
  double target_size(Index cell, Index region) const;
  bool uneven_at_vertex(Index cell) const;
  void note_edges(const ConflictZone& zone, Index vertex);

  const Domain& domain_;
  const RefinedMesh& mesh_;
  const CollarCells& collar_cells_;
  const RestrictedSurface& surface_;
  const GradedSizes& sizes_;
  const FacingSheets& facing_sheets_;
  RandomOffsets& random_;
  WorkQueue& queue_;
  bool leaves_narrow_cells_;
  GrowingArray<double> shortest_edge_;  // by vertex; empty without a vertex ratio
  std::vector<Index> cells_;            // scratch
};

}  // namespace collarmesh
