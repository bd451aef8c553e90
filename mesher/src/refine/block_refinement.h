#pragma once

#include <tbb/enumerable_thread_specific.h>

#include <span>
#include <vector>

#include "refine/cell_quality.h"
#include "refine/collar_cells.h"
#include "refine/curve_chains.h"
#include "refine/graded_sizes.h"
#include "refine/refined_mesh.h"
#include "refine/restricted_surface.h"
#include "refine/surface_nodes.h"
#include "refine/unresolved_points.h"
#include "refine/work_queue.h"

namespace collarmesh {

/// Destroys many skinny or large cells at once, by several threads, where nothing but cells is around.
///
/// A vertex is quiet when it lies on no feature and nothing is found from it: no part of the surface, no
/// point, no protective ball, no collar. A zone between quiet vertices is nobody's business but that of the
/// mesh, the labels and the quality of cells. So a round takes the first bucket of the queue, divides the
/// quiet vertices into blocks, and refines each block as the loop does: skinny cells first. What does not lie
/// in one block waits in the queue; the blocks are others in the next round, and what is left then is little
/// enough for the loop. (Of a study of several ways this one cost a single thread the least.)
///
/// The mesh does not depend on the number of threads: blocks depend on the mesh alone, random offsets on the
/// centre of the cell that is destroyed. The loop says when the queue may be taken from.
class BlockRefinement {
 public:
  /// All are kept by reference.
  BlockRefinement(const Domain& domain, RefinedMesh& mesh, SurfaceNodes& nodes, const CollarSystem& collars,
                  CollarCells& collar_cells, RestrictedSurface& surface, const GradedSizes& sizes,
                  const UnresolvedPoints& points, const CurveChains& curves, const CellQuality& cells,
                  WorkQueue& queue);

  /// Are cells next in the queue, and so many that a round is worth its while?
  bool due();
  /// A round. Precondition: it is due.
  void round();
  /// Vertices that all rounds have inserted.
  std::size_t inserted() const { return inserted_; }
  LargestZone largest_zone() const;

 private:
  struct Waiting {
    WorkQueue::Priority priority;
    unsigned bucket;
    WorkQueue::Entry entry;
  };
  struct Worker {
    WorkQueue queue;
    ConflictZone zone;
    LargestZone largest;
  };
  /// A node of a binary tree in an array: below the cut is node 2 i + 1, above 2 i + 2. The leaves are
  /// blocks.
  struct Cut {
    std::size_t axis;
    double place;
  };

  std::size_t most_insertions() const;
  std::size_t block_count() const;
  void cut(std::size_t node, std::span<Point> sample);
  void divide_vertices();
  bool quiet(Index vertex) const;
  std::uint16_t block_at(const Point& p) const;
  std::uint16_t owner_of(Index cell) const;
  std::vector<std::vector<WorkQueue::Entry>> deal(const std::vector<WorkQueue::Entry>& taken);
  std::vector<Index> room_for(const std::vector<std::vector<WorkQueue::Entry>>& entries) const;
  void refine(Triangulation::Block& block, const std::vector<WorkQueue::Entry>& entries, Worker& worker,
              std::vector<Waiting>& waiting) const;
  bool destroy(Index cell, Triangulation::Block& block, Worker& worker) const;

  const Domain& domain_;
  RefinedMesh& mesh_;
  SurfaceNodes& nodes_;
  const CollarSystem& collars_;
  CollarCells& collar_cells_;
  RestrictedSurface& surface_;
  const UnresolvedPoints& points_;
  const CurveChains& curves_;
  const CellQuality& cells_;
  WorkQueue& queue_;
  std::size_t next_round_;  // not before there are so many vertices
  std::uint64_t rounds_ = 0;
  std::size_t inserted_ = 0;
  // During a round:
  WorkQueue::Priority priority_ = WorkQueue::large_cells;
  unsigned bucket_ = 0;
  std::vector<Cut> cuts_;
  Triangulation::Owners owners_;
  tbb::enumerable_thread_specific<Worker> workers_;
};

}  // namespace collarmesh
