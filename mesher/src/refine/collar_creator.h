#pragma once

#include <functional>
#include <memory>
#include <unordered_map>
#include <utility>
#include <vector>

#include "collar/collar_placement.h"
#include "collarmesh/trace.h"
#include "refine/collar_cells.h"
#include "refine/curve_chains.h"
#include "refine/gap_explorer.h"
#include "refine/graded_sizes.h"
#include "refine/restricted_surface.h"
#include "refine/unresolved_points.h"

namespace collarmesh {

/// The part that creates the collars: all of them before refinement, or each in the pass, that is, while the
/// loop refines (paper, section 3.2 and Procedures 3 and 4). A vertex ball is created when the vertex is
/// inserted or, before that, when it is isolated and medial. The balls along a crease curve are created when
/// it is isolated in all Voronoi cells that it crosses outside its ends' balls, or when one of its
/// subsegments would be split.
/// Invariant: the centre of every ball and every corner point of the collars is an unresolved point or a mesh
/// vertex. Only this class adds balls to the system, and reports them to cells, surface and curves. The loop
/// starts it, reports insertions and decides when curves get their balls; the parts that stitch ask it for
/// the vertices of balls.
class CollarCreator {
 public:
  /// Keeps all by reference. Calls `stopped` now and then with a lower bound on the number of vertices to
  /// come, and stops if it returns true.
  CollarCreator(const Domain& domain, const RefinedMesh& mesh, const SurfaceNodes& nodes,
                const GradedSizes& sizes, CollarSystem& collars, CollarCells& collar_cells,
                RestrictedSurface& surface, UnresolvedPoints& points, CurveChains& curves,
                OpenCreases& open_creases, std::function<bool(std::size_t)> stopped)
      : domain_(domain),
        mesh_(mesh),
        nodes_(nodes),
        sizes_(sizes),
        collars_(collars),
        collar_cells_(collar_cells),
        surface_(surface),
        points_(points),
        curves_(curves),
        open_creases_(open_creases),
        stopped_(std::move(stopped)) {}

  /// Starts the creation. Precondition: the vertices of the complex are the first unresolved points, in their
  /// order. If stopped, the system stays incomplete.
  void start();
  /// Returns the mesh vertex at a ball's centre; none as long as it is unresolved.
  Index vertex_of(Index ball) const { return points_[ball_points_[ball]].vertex; }

  /// Returns the reason why a ball was placed.
  BallReason reason(Index ball) const { return reasons_[ball]; }

  // Functions for collars created in the pass:
  /// Returns whether an unresolved point is a crease vertex of the complex that has no ball yet.
  bool waits_for_ball(Index point) const {
    return placement_ && collars_.is_crease_vertex(point) && collars_.ball_at_vertex(point) == none;
  }
  /// Creates the ball of a vertex (paper, Procedure 4). `near` is the mesh vertex whose Voronoi cell contains
  /// the vertex. Precondition: the vertex waits for its ball.
  void create_at_vertex(Index vertex, Index near, BallReason reason);
  /// Looks for crease vertices or curves that have become isolated. Creates the balls of vertices at once;
  /// those of curves are created by `create_on_isolated_curves`. Precondition: the new cells were reported to
  /// all other parts.
  void cells_made(const ConflictZone& zone, Index vertex);
  /// Creates the balls of curves that have become isolated.
  void create_on_isolated_curves();
  /// Creates the balls of a crease instead of splitting its subsegment, unless the crease still waits for
  /// points of its chain or, in the paper's profile, is not isolated. Returns whether it did so; then the
  /// subsegment no longer exists. Precondition: the subsegment exists.
  bool create_at_subsegment(Index subsegment);
  /// Creates the balls of all creases that have none yet. Returns false if there are no such creases.
  /// Precondition: the queue is empty, so the ends of creases have their balls.
  bool create_remaining();

  /// Returns the explorer of gap sizes in the current mesh.
  GapExplorer& gap_size();
  /// Returns the explorer of gap sizes; null if it was never used.
  const GapExplorer* gap_explorer() const { return gap_.get(); }
  /// For tests: sets a function to call for every ball as soon as it is created.
  void observe(std::function<void(const CollarBall&)> observer) { observer_ = std::move(observer); }

 private:
  double target_size(const Feature& feature, const Point& p) const;
  void create_if_isolated(Index at);
  bool is_isolated(Index curve);
  void create_on_curve(Index curve, BallReason reason);
  void take_up_balls(Index near, const std::array<Index, 2>& ends, BallReason reason);
  void find_inside(const CollarBall& ball, Index near);

  const Domain& domain_;
  const RefinedMesh& mesh_;
  const SurfaceNodes& nodes_;
  const GradedSizes& sizes_;
  CollarSystem& collars_;
  CollarCells& collar_cells_;
  RestrictedSurface& surface_;
  UnresolvedPoints& points_;
  CurveChains& curves_;
  OpenCreases& open_creases_;
  std::function<bool(std::size_t)> stopped_;
  std::unique_ptr<GapExplorer> gap_;            // created on first use
  std::unique_ptr<CollarPlacement> placement_;  // set only if collars are created in the pass
  // By curve: the number of links at the start of its chain that are known to be isolated.
  std::unordered_map<Index, std::size_t> isolated_;
  std::vector<Index> ball_points_;   // by ball: the unresolved point at its centre
  std::vector<BallReason> reasons_;  // by ball
  std::size_t corners_taken_up_ = 0;
  std::function<void(const CollarBall&)> observer_;
  std::vector<Index> scratch_;
};

}  // namespace collarmesh
