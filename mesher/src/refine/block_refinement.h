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

/// The part that destroys many skinny or large cells, or triangles of the surface, at once, with several
/// threads.
///
/// A vertex may belong to a block if it lies on no vertex or curve of the complex, if no unresolved point and
/// no centre of a protective ball lies in its Voronoi cell, and if no collar is near. An insertion among such
/// vertices only concerns the mesh, the surface and the quality of triangles and cells. So a round takes the
/// first bucket of the queue, divides these vertices into blocks, and refines each block as the loop does: in
/// the same order of priorities, and with cells that yield to triangles. Entries that do not lie within one
/// block wait in the queue. The next round has other blocks; the loop handles the few entries that remain.
///
/// The mesh does not depend on the number of threads: blocks depend only on the mesh, and random offsets only
/// on the seed and the cell or triangle to destroy. The loop decides when a round may take entries from the
/// queue.
class BlockRefinement {
 public:
  /// Keeps all by reference.
  BlockRefinement(const Domain& domain, RefinedMesh& mesh, SurfaceNodes& nodes, const CollarSystem& collars,
                  CollarCells& collar_cells, RestrictedSurface& surface, const GradedSizes& sizes,
                  const UnresolvedPoints& points, const CurveChains& curves, const TriangleQuality& triangles,
                  const CellQuality& cells, WorkQueue& queue);

  /// Returns whether cells or triangles are next in the queue, and enough of them to make a round worthwhile.
  bool is_due();
  /// Runs a round. Precondition: `is_due` has just returned true.
  void round();
  /// Returns the number of vertices that all rounds have inserted.
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
  /// The data of a thread while it refines a block. It is kept to the end, because SurfaceNodes points into
  /// its lists.
  struct Worker {
    explicit Worker(const Domain& domain);

    WorkQueue queue;
    ConflictZone zone;
    SurfaceNodes::Workspace nodes;
    LargestZone largest;
    std::size_t yields = 0;
  };
  /// The block that a thread refines.
  struct Block {
    Triangulation::Block& mesh;
    RestrictedSurface::Workspace& surface;
  };
  /// A node of a binary tree in an array. Below the cut of node i is its child 2 i + 1, above the cut its
  /// child 2 i + 2. The leaves are blocks.
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
  bool is_due(const WorkQueue::Item& item) const;
  double squared_radius(const WorkQueue::Item& item) const;
  std::optional<Candidate> candidate(const WorkQueue::Item& item, RandomOffsets& random) const;
  enum class Fate {
    destroyed,  ///< a vertex was inserted to destroy it
    stays,      ///< no vertex can be inserted to destroy it
    waits       ///< the loop will handle it
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
  std::size_t next_round_;  // no round begins before the mesh has this number of vertices
  std::uint64_t rounds_ = 0;
  std::size_t inserted_ = 0;
  // Data of the current round:
  WorkQueue::Priority priority_ = WorkQueue::large_cells;
  unsigned bucket_ = 0;
  std::vector<Cut> cuts_;
  Triangulation::Owners owners_;
  std::vector<std::unique_ptr<Worker>> workers_;
  std::vector<Worker*> idle_workers_;
  std::mutex of_workers_;
};

}  // namespace collarmesh
