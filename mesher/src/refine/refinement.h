#pragma once

#include <functional>
#include <optional>
#include <string>

#include "collar/collar_system.h"
#include "collarmesh/mesher.h"
#include "refine/block_refinement.h"
#include "refine/budget.h"
#include "refine/cell_quality.h"
#include "refine/collar_cells.h"
#include "refine/collar_creator.h"
#include "refine/collar_review.h"
#include "refine/collar_surface.h"
#include "refine/curve_chains.h"
#include "refine/domain.h"
#include "refine/extract.h"
#include "refine/facing_sheets.h"
#include "refine/graded_sizes.h"
#include "refine/open_creases.h"
#include "refine/outcome.h"
#include "refine/random_offsets.h"
#include "refine/refined_mesh.h"
#include "refine/restricted_surface.h"
#include "refine/rip_and_stitch.h"
#include "refine/surface_check.h"
#include "refine/surface_nodes.h"
#include "refine/surface_topology.h"
#include "refine/trace_recorder.h"
#include "refine/triangle_quality.h"
#include "refine/unresolved_points.h"
#include "refine/work_counter.h"
#include "refine/work_queue.h"

namespace collarmesh {

/// Sparse Voronoi Refinement of a complex (paper, Procedures 1 to 3): the loop. Only the loop calls all
/// parts, and it contains nothing but their order (doc/architecture/refinement_parts.md).
class Refinement {
 public:
  Refinement(const Plc& plc, const MeshOptions& options, const Execution& execution);

  /// Refines until nothing is left to do, a budget is spent or the caller cancels.
  MeshStatus run();
  /// Returns whether the run ended with `budget_hit`, but not because of the time limit, after it had begun
  /// to bound the radius-edge ratio in narrow cells, too.
  bool narrow_cells_are_dear() const { return narrow_cells_are_dear_; }
  /// Returns the mesh, after run() returned complete or guarantee_missed.
  Extracted extract() const;

  /// For tests: sets a function to call before each piece of work that the loop takes up because no skinny
  /// cell is left.
  void observe_quality_phases(std::function<void()> observer) { observer_ = std::move(observer); }
  /// For tests: sets a function to call for every collar ball as soon as refinement creates it.
  void observe_collars(std::function<void(const CollarBall&)> observer) {
    collar_creator_.observe(std::move(observer));
  }
  /// Returns the feature that a mesh vertex lies on; dimension 3: none.
  const Feature& feature_of(Index vertex) const { return mesh_.feature(vertex); }
  const Triangulation& triangulation() const { return mesh_.triangulation(); }
  bool in_collar(Index cell) const { return collar_cells_.inside(cell); }
  /// Returns the explorer of gap sizes in the current mesh.
  GapExplorer& gap_size() { return collar_creator_.gap_size(); }

  /// Turns on the recording of steps. Call it before run().
  void record_steps() { trace_.emplace(refined()); }
  /// Returns the recorded steps.
  Trace trace() const { return trace_ ? trace_->trace() : Trace(); }
  const std::string& message() const { return outcome_.message(); }
  Point where() const { return domain_.frame.outside(outcome_.where()); }
  MeshStatistics statistics() const;

 private:
  /// Starts all parts. The order matters: collars and curves assume that the first unresolved points are the
  /// complex's vertices, in their order; curves ask which creases balls cover and where balls clip them;
  /// cells can be judged only when it is known which of them lie in collars.
  void start();
  void process(const WorkQueue::Item& item);
  void destroy_cell(const WorkQueue::Item& item);
  void destroy_triangle(const WorkQueue::Item& item);
  bool destroy_subsegment(Index subsegment, bool queue_again);
  void split_ahead(Index subsegment);
  bool join(const CurveChains::Split& split);
  bool yield_to(Index subsegment, const Candidate& candidate);
  /// Inserts a candidate, or the point that it yields or warps to (paper, Procedure 2). Returns false if
  /// nothing could be inserted.
  bool destroy(Candidate candidate);
  void resolve_point(Index point);
  void insert_point(Index point);
  /// Inserts a point (paper, Procedure 3). Precondition: zone_ is the point's conflict zone. Returns the new
  /// vertex.
  Index force_insert(const Feature& feature);
  bool at_floor(const Candidate& candidate) const {
    return domain_.at_floor(candidate.point, candidate.squared_radius);
  }
  bool check_gradation();
  bool check_collars();
  /// Bounds the radius-edge ratio in narrow cells when no other work is left. Returns whether there is more
  /// work now.
  bool bound_narrow_cells();
  /// Returns whether a budget is spent, given a lower bound on the vertices to come.
  bool stopped(std::size_t planned_vertices = 0);
  bool is_budget_spent(std::size_t planned_vertices);
  std::size_t bytes() const;
  bool too_early();
  WorkCounts work_counts() const;
  std::size_t ripped_out() const;
  Refined refined() const;

  const Domain domain_;
  Outcome outcome_;
  Budget budget_;
  WorkQueue queue_;
  CollarSystem collars_;
  RandomOffsets random_;

  // Parts that represent the mesh:
  RefinedMesh mesh_;
  SurfaceNodes nodes_;
  CollarCells collar_cells_;
  RestrictedSurface surface_;
  GradedSizes sizes_;
  FacingSheets facing_sheets_;
  // Parts that queue work:
  UnresolvedPoints points_;
  OpenCreases open_creases_;
  CurveChains curves_;
  TriangleQuality triangles_;
  CellQuality cells_;
  CollarCreator collar_creator_;
  BlockRefinement blocks_;
  // Parts used when the queue is empty:
  CollarSurface collar_surface_;
  CollarReview collar_review_;
  SurfaceCheck surface_check_;
  RipAndStitch stitching_;
  SurfaceTopology topology_;

  ConflictZone zone_;
  std::optional<WorkCounter> counter_;  // set only if counts are wanted
  std::optional<TraceRecorder> trace_;
  WorkQueue::Priority working_on_ = WorkQueue::priority_count;
  std::size_t steps_ = 0, warps_ = 0, yields_ = 0;
  double seconds_ = 0;
  std::size_t most_with_narrow_cells_ = 0;  // limit on vertices once the ratio of narrow cells is bounded; 0
                                            // before
  bool narrow_cells_are_dear_ = false;
  std::function<void()> observer_;
};

}  // namespace collarmesh
