#pragma once

#include <array>
#include <cassert>
#include <optional>
#include <vector>

#include "collar/collar_system.h"
#include "common/growing_array.h"
#include "location/location_objects.h"
#include "refine/candidate.h"
#include "refine/facing_sheets.h"
#include "refine/graded_sizes.h"
#include "refine/open_creases.h"
#include "refine/outcome.h"
#include "refine/random_offsets.h"
#include "refine/subsegment.h"
#include "refine/unresolved_points.h"
#include "refine/work_queue.h"

namespace collarmesh {

/// The chains of curves: each curve is cut into subsegments. Until a subsegment is split, its protective ball
/// keeps vertices of other features away.
///
/// Chains run ahead of the mesh, like the paper's one-dimensional meshes: a subsegment ends at mesh vertices
/// or at unresolved points. A subsegment that a vertex encroaches is split by an unresolved point, which is
/// inserted when no skinny cell is left. So a vertex never forces other vertices to be inserted at once, and
/// no protective ball contains a vertex for long. Invariants, between insertions: the subsegments of a curve
/// without a collar cover it; a subsegment whose ball contains a mesh vertex, or that is resolved and too
/// coarse, is in the queue; each ball is found from the mesh vertex nearest to its centre. The loop reports
/// insertions and resolved points, and makes the splits; SurfaceCheck asks for further splits; CollarCreator
/// clips chains, learns of the chains of creases through OpenCreases, and in the end replaces a crease's
/// chain by its collar.
class CurveChains {
 public:
  /// A place at which a subsegment will be split.
  struct Split {
    Candidate candidate;  ///< start == none: the place already has a mesh vertex, `vertex`
    ChainLink link;
    double parameter;
    Index vertex;  ///< mesh vertex nearest to the place
  };
  /// The place where a curve that is no crease leaves the ball at its end.
  struct ClippedEnd {
    Index curve, ball;
    Index point;  ///< the unresolved point there
  };
  /// Keeps all by reference.
  CurveChains(const Domain& domain, const RefinedMesh& mesh, const CollarSystem& collars,
              UnresolvedPoints& points, OpenCreases& open_creases, const GradedSizes& sizes,
              const FacingSheets& facing_sheets, RandomOffsets& random, Outcome& outcome, WorkQueue& queue)
      : domain_(domain),
        mesh_(mesh),
        collars_(collars),
        points_(points),
        open_creases_(open_creases),
        sizes_(sizes),
        facing_sheets_(facing_sheets),
        random_(random),
        outcome_(outcome),
        queue_(queue) {}

  /// Starts the chains of all curves that no balls cover. Precondition: the vertices of the complex are the
  /// first unresolved points, in their order.
  void start();

  /// Returns the subsegment in whose protective ball a candidate with this zone lies deepest (paper,
  /// Procedure 2); none if it encroaches none.
  Index encroached(const ConflictZone& zone, const Candidate& candidate) const;
  /// Returns whether the centre of any protective ball lies in the Voronoi cell of this mesh vertex.
  bool any_at(Index mesh_vertex) const { return balls_.first_at(mesh_vertex) != none; }
  /// Returns the end of a subsegment to insert instead of a candidate that encroaches the subsegment: of the
  /// unresolved ends that are medial, the one nearer to the candidate. None if there is no such end.
  Index end_to_resolve(Index subsegment, const Candidate& candidate) const;

  /// Returns whether the subsegment of a queue entry still exists.
  bool is_due(const WorkQueue::Entry& entry) const { return is_there({entry.id, entry.stamp}); }
  // To split a subsegment the loop calls:
  // 1. CollarCreator::create_at_subsegment; if that returns true, nothing more;
  // 2. `split_of`; if that returns nothing, nothing more;
  // 3. if the place already has a vertex (`start` is none): `can_join` and, if that returns true, `split_at`
  //    after the vertex has joined the curve;
  //    if the vertex is to be inserted later: `split_ahead`;
  //    if the candidate warps: `queue_again` after the other point was inserted, if the subsegment came from
  //    the queue;
  //    otherwise: `drop_ball`, force_insert and `split_at`.
  /// Returns where to split a subsegment. If its ball is at the floor, gives up and returns nothing.
  /// Precondition: the subsegment exists (`is_due`, or `encroached`).
  std::optional<Split> split_of(Index subsegment);
  /// Returns whether the mesh vertex at the place can split the subsegment: it must not be one of its ends.
  bool can_join(const Split& split) const;
  /// Splits a subsegment by an unresolved point. Precondition: no mesh vertex is at the place.
  void split_ahead(const Split& split);
  /// Removes the ball of a subsegment before the vertex that splits it is inserted, possibly inside the ball.
  void drop_ball(const Split& split);
  /// Splits a subsegment by a mesh vertex at the place of the split. Precondition: `GradedSizes` has the
  /// vertex's size.
  void split_at(const Split& split, Index vertex);
  /// Queues again a subsegment that is too coarse, if it still exists after another insertion.
  void queue_again(const Split& split);

  /// Reports that an unresolved point has become a mesh vertex; updates the subsegments that end there.
  void point_resolved(Index point);
  /// Reports a new vertex. Balls are found from it if it is nearest to their centres, and subsegments whose
  /// balls contain it are queued. Precondition: the mesh has the vertex, and its unresolved point, if any, is
  /// resolved.
  void cells_made(const ConflictZone& zone, Index vertex);
  /// Judges all subsegments because sizes have changed everywhere.
  void judge_all();
  /// Queues a subsegment that must be split before skinny cells are destroyed.
  void encroach(Index subsegment);

  /// Visits all subsegments with their numbers.
  template <class Visit>
  void visit(const Visit& visit) const {
    for (Index s = 0; s < subsegments_.size(); ++s)
      if (subsegments_[s].alive) visit(s, subsegments_[s].piece);
  }
  /// Visits all subsegments with the places of their ends.
  template <class Visit>
  void visit_places(const Visit& visit) const {
    for (Index i = 0; i < subsegments_.size(); ++i)
      if (const Chained& s = subsegments_[i]; s.alive) visit(s.piece, std::array{place(s, 0), place(s, 1)});
  }
  const std::vector<ClippedEnd>& clipped_ends() const { return clipped_ends_; }

  // Functions for collars created in the pass:
  /// Reports that a vertex of the complex has its ball: a curve that ends there now ends on the sphere.
  void clip(Index curve, bool at_start, Index near);
  /// Returns the subsegment of a link, if it still exists.
  const Subsegment* find(const ChainLink& link) const {
    return is_there(link) ? &subsegments_[link.subsegment].piece : nullptr;
  }
  /// Removes a chain that balls replace: its subsegments, and the unresolved points between them. Returns a
  /// mesh vertex near it; none if there was no chain.
  Index remove_chain(Index curve);
  /// Returns the mesh vertices between the ends of a chain, in their order.
  std::vector<PlaceOnCurve> vertices_amid(Index curve) const;
  /// Returns the curve of a subsegment. Precondition: the subsegment exists.
  Index curve_of(Index subsegment) const {
    assert(subsegments_[subsegment].alive);
    return subsegments_[subsegment].piece.curve;
  }

  const LocationObjects& balls() const { return balls_; }
  std::size_t bytes() const;

 private:
  /// The end of a subsegment: a mesh vertex or, before there is one, an unresolved point.
  struct End {
    Index vertex, point;
    double parameter;
  };
  struct Chained {
    Subsegment piece;
    std::array<Index, 2> points;      // unresolved points at its ends; none where there are mesh vertices
    std::array<Index, 2> neighbours;  // previous and next piece on the curve; none at its ends
    Index ball;
    std::uint32_t stamp;
    bool alive;
  };

  void add_chain(Index curve);
  void chain_resolved(Index curve, Index piece);
  std::vector<End> first_ends(Index curve);
  End end_of(const Chained& s, unsigned side) const {
    return {s.piece.ends[side], s.points[side], s.piece.parameters[side]};
  }
  const Point& place(const Chained& s, unsigned side) const {
    return s.points[side] == none ? mesh_.point(s.piece.ends[side]) : points_[s.points[side]].point;
  }
  Index add(Index curve, const std::array<End, 2>& ends, Index near);
  void note_piece(Index point, Index subsegment);
  void link(Index curve, Index before, Index after);
  void cut(Index subsegment, const End& middle, Index near);
  void cut_off(Index first, unsigned side, const End& end, Index near);
  void remove(Index subsegment);
  void withdraw(Index point, Index curve);
  void judge(Index subsegment);
  bool holds(const Chained& s, Index vertex) const;
  bool is_end(const Chained& s, Index vertex) const;
  void resolve_end(Index subsegment, unsigned side);
  double leaving_parameter(Index curve, const CollarBall& ball, bool at_start) const;
  double bisecting_parameter(Index curve, const Point& a, const Point& b, double from, double to) const;
  void queue(WorkQueue::Priority priority, Index subsegment);
  bool too_coarse(const Chained& s) const;
  bool turns_too_far(const Chained& s) const;
  double tolerance_of(const Subsegment& s) const;
  bool leaves_chord(const Chained& s, double sagitta) const;
  bool is_there(const ChainLink& link) const {
    return subsegments_[link.subsegment].alive && subsegments_[link.subsegment].stamp == link.stamp;
  }

  const Domain& domain_;
  const RefinedMesh& mesh_;
  const CollarSystem& collars_;
  UnresolvedPoints& points_;
  OpenCreases& open_creases_;
  const GradedSizes& sizes_;
  const FacingSheets& facing_sheets_;
  RandomOffsets& random_;
  Outcome& outcome_;
  WorkQueue& queue_;
  LocationObjects balls_;
  GrowingArray<Chained> subsegments_;
  std::vector<Index> free_subsegments_;
  std::vector<std::array<Index, 2>> chain_ends_;  // by curve: its first and last subsegment
  GrowingArray<Index> piece_at_;                  // by unresolved point on a curve: a piece that ends there
  std::vector<ClippedEnd> clipped_ends_;
};

}  // namespace collarmesh
