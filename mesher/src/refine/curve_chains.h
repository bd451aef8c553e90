#pragma once

#include <optional>
#include <span>
#include <utility>
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

/// The chains of curves: each is cut into subsegments, whose protective balls keep other features' samples
/// away until they are split.
///
/// A curve starts as first subsegments between unresolved points. Each waits, guarded by a ball of its own,
/// until both ends are in the mesh. Invariants, between insertions: what is left of a curve that has no
/// collar is covered by its subsegments and by those that wait; a subsegment whose ball holds a mesh vertex,
/// or that is too coarse, is in the queue; each ball is found from the mesh vertex that is nearest to its
/// centre. The loop tells of insertions and of resolved points, and splits; SurfaceCheck wants more;
/// CollarCreator clips chains, and in the end gives a crease its collar instead. It learns of the chains of
/// creases through OpenCreases.
class CurveChains {
 public:
  /// A place where a subsegment is to be split.
  struct Split {
    Candidate candidate;  ///< start == none: a mesh vertex is there already, `vertex`
    ChainLink link;
    Subsegment piece;
    double parameter;
    Index vertex;  ///< nearest to the place
  };
  /// Where a curve that is no crease leaves the ball at its end.
  struct ClippedEnd {
    Index curve, ball;
    Index point;  ///< unresolved
  };
  /// All are kept by reference.
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

  /// Start the chains of all curves that no balls cover. Precondition: the vertices of the complex are the
  /// first unresolved points, in their order.
  void start();

  /// Paper, Procedure 2: the protective ball that a candidate with this zone lies deepest in; none if it
  /// encroaches none.
  Index encroached(const ConflictZone& zone, const Candidate& candidate) const;
  /// Is any ball found from this mesh vertex?
  bool any_at(Index mesh_vertex) const { return balls_.first_at(mesh_vertex) != none; }
  /// The subsegment that such a ball belongs to; none if it still waits.
  Index subsegment_of(Index ball) const;
  /// The end of a waiting subsegment, not resolved yet, that is nearest to a point in its ball: what would
  /// encroach it brings the ends in, so that nothing comes too close to a curve that is not resolved yet.
  Index end_to_resolve(Index ball, const Point& intruder) const;

  bool due(const WorkQueue::Entry& entry) const { return is_there({entry.id, entry.stamp}); }
  // To split a subsegment the loop calls, in this order: CollarCreator::create_at_subsegment, which must say
  // no; `split_of`; `remove`; force_insert; `add_pieces`. Where a vertex is there already (`start` is none),
  // `can_join` must say yes before `remove`, and the vertex takes over the curve as its feature instead of
  // force_insert. When the candidate warps, nothing is removed, and `queue_again` follows.
  /// Where to split a subsegment; nothing, and given up, when its ball is at the floor. Precondition: the
  /// subsegment is there (`due`, or `subsegment_of` a ball).
  std::optional<Split> split_of(Index subsegment);
  /// Does the mesh vertex at the place split the subsegment? Not if it is one of its ends.
  bool can_join(const Split& split) const;
  /// A subsegment is about to be split: its ball goes before the vertex comes, which may lie in it.
  /// Precondition: nothing was inserted since `split_of`.
  void remove(const Split& split);
  /// The two pieces of a subsegment that was removed. Precondition: the mesh has this vertex at the place,
  /// and sizes know it.
  void add_pieces(const Split& split, Index vertex);
  /// Queue a subsegment again if it is still there after something else was inserted.
  void queue_again(const Split& split, WorkQueue::Priority priority);

  /// An unresolved point has become a mesh vertex: first subsegments that waited for it may start.
  void point_resolved(Index point);
  /// A vertex has come: balls that it is nearest to move to it. Subsegments whose balls hold it are queued,
  /// or, while they still wait, their ends. Precondition: the mesh has the vertex.
  void cells_made(const ConflictZone& zone, Index vertex);
  /// Sizes have changed everywhere.
  void judge_all();
  /// Split a subsegment when its turn comes, before skinny cells.
  void encroach(Index subsegment);

  /// Visit all subsegments: their numbers and what they are.
  template <class Visit>
  void visit(const Visit& visit) const {
    for (Index s = 0; s < subsegments_.size(); ++s)
      if (subsegments_[s].alive) visit(s, subsegments_[s].piece);
  }
  const std::vector<ClippedEnd>& clipped_ends() const { return clipped_ends_; }

  // For collars that are created in the pass:
  /// A vertex of the complex has got its ball: a curve that ends there does so on the sphere.
  void clip(Index curve, bool at_start, Index near);
  /// The subsegment of a link, if it is still there.
  const Subsegment* find(const ChainLink& link) const {
    return is_there(link) ? &subsegments_[link.subsegment].piece : nullptr;
  }
  void remove(const ChainLink& link) { remove_subsegment(link.subsegment); }
  Index curve_of(Index subsegment) const { return subsegments_[subsegment].piece.curve; }

  const LocationObjects& balls() const { return balls_; }
  std::size_t bytes() const;

 private:
  struct Chained {
    Subsegment piece;
    Index ball;
    std::uint32_t stamp;
    bool alive;
  };
  /// A subsegment of a curve's first chain, waiting for its ends to be inserted.
  struct Pending {
    Index curve;
    std::array<Index, 2> points;  // unresolved points
    std::array<double, 2> parameters;
    Index ball = none;
    unsigned missing = 2;
  };

  void add_chain(Index curve);
  void guard(Index pending, Index near);
  std::vector<Index>& waiting_for(Index point);
  void hurry_ends(const Pending& pending);
  double leaving_parameter(Index curve, const CollarBall& ball, bool at_start) const;
  double bisecting_parameter(Index curve, const Point& a, const Point& b, double from, double to) const;
  void add_subsegment(Index curve, std::array<Index, 2> ends, std::array<double, 2> parameters, Index nearby);
  void remove_subsegment(Index subsegment);
  void queue(WorkQueue::Priority priority, Index subsegment);
  bool too_coarse(const Subsegment& s) const;
  bool turns_too_far(const Subsegment& s) const;
  bool leaves_chord(const Subsegment& s, double sagitta) const;
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
  std::vector<Pending> pending_;
  std::vector<std::vector<Index>> waiting_;  // by unresolved point: first subsegments
  std::vector<ClippedEnd> clipped_ends_;
};

}  // namespace collarmesh
