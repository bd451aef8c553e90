#pragma once

#include <array>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "refine/cell_quality.h"
#include "refine/collar_cells.h"
#include "refine/curve_chains.h"
#include "refine/graded_sizes.h"
#include "refine/random_offsets.h"
#include "refine/refined_mesh.h"
#include "refine/restricted_surface.h"
#include "refine/surface_nodes.h"
#include "refine/triangle_quality.h"
#include "refine/unresolved_points.h"
#include "refine/work_queue.h"

namespace collarmesh {

/// Destroys many skinny or large cells, or triangles of the surface, at once, by several threads.
///
/// A vertex may belong to a block when it lies on no vertex or curve of the complex, and no point, no
/// protective ball and no collar is found from it. A zone between such vertices is the business of the mesh,
/// the surface and the quality of triangles and cells alone. So a round takes the first bucket of the queue,
/// divides these vertices into blocks, and refines each block as the loop does: in the same order of
/// priorities, with cells that yield to triangles. What does not lie in one block waits in the queue; the
/// blocks are others in the next round, and what is left then is little enough for the loop. (Of a study of
/// several ways this one cost a single thread the least.)
///
/// The mesh does not depend on the number of threads: blocks depend on the mesh alone, random offsets on
/// what is destroyed. The loop says when the queue may be taken from.
class BlockRefinement {
 public:
  /// All are kept by reference.
  BlockRefinement(const Domain& domain, RefinedMesh& mesh, SurfaceNodes& nodes, const CollarSystem& collars,
                  CollarCells& collar_cells, RestrictedSurface& surface, const GradedSizes& sizes,
                  const UnresolvedPoints& points, const CurveChains& curves, const TriangleQuality& triangles,
                  const CellQuality& cells, WorkQueue& queue);

  /// Are cells or triangles next in the queue, and so many that a round is worth its while?
  bool due();
  /// A round. Precondition: it is due.
  void round();
  /// Vertices that all rounds have inserted.
  std::size_t inserted() const { return inserted_; }
  LargestZone largest_zone() const;
  std::size_t yields() const;
  std::size_t bytes() const;

 private:
  struct Waiting {
    WorkQueue::Priority priority;
    unsigned bucket;
    WorkQueue::Entry entry;
  };
  /// Lent to a thread for a block; kept to the end, as SurfaceNodes points into its lists.
  struct Worker {
    explicit Worker(const Domain& domain);

    WorkQueue queue;
    ConflictZone zone;
    SurfaceNodes::Workspace nodes;
    LargestZone largest;
    std::size_t yields = 0;
  };
  /// What a thread works on.
  struct Block {
    Triangulation::Block& mesh;
    RestrictedSurface::Workspace& surface;
  };
  /// A node of a binary tree in an array: below the cut is node 2 i + 1, above 2 i + 2. The leaves are
  /// blocks.
  struct Cut {
    std::size_t axis;
    double place;
  };

  Worker& take_worker();
  void give_back(Worker& worker);
  std::size_t most_insertions() const;
  std::size_t block_count() const;
  void cut(std::size_t node, std::span<Point> sample);
  void divide_vertices();
  bool may_belong_to_block(Index vertex) const;
  std::uint16_t block_at(const Point& p) const;
  std::uint16_t owner_of(const std::array<Index, 4>& vertices) const;
  std::uint16_t owner_of(const WorkQueue::Entry& entry) const;
  std::vector<std::vector<WorkQueue::Entry>> deal(const std::vector<WorkQueue::Entry>& taken);
  std::vector<Index> room_for(const std::vector<std::vector<WorkQueue::Entry>>& entries) const;
  std::vector<std::size_t> records_for(std::span<const Index> room) const;
  void refine(Block block, const std::vector<WorkQueue::Entry>& entries, Worker& worker,
              std::vector<Waiting>& waiting);
  bool any_left(WorkQueue& queue) const;
  bool due(const WorkQueue::Item& item) const;
  double squared_radius(const WorkQueue::Item& item) const;
  std::optional<Candidate> candidate(const WorkQueue::Item& item, RandomOffsets& random) const;
  enum class Fate {
    destroyed,  ///< something was inserted for its sake
    stays,      ///< nothing can be inserted for it
    waits       ///< for the loop
  };
  Fate destroy(const WorkQueue::Item& item, Block block, Worker& worker);
  bool insert(const Candidate& candidate, Block block, Worker& worker);

  const Domain& domain_;
  RefinedMesh& mesh_;
  SurfaceNodes& nodes_;
  const CollarSystem& collars_;
  CollarCells& collar_cells_;
  RestrictedSurface& surface_;
  const UnresolvedPoints& points_;
  const CurveChains& curves_;
  const TriangleQuality& triangles_;
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
  std::vector<std::unique_ptr<Worker>> workers_;
  std::vector<Worker*> idle_workers_;
  std::mutex of_workers_;
};

}  // namespace collarmesh
