#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <functional>
#include <memory>
#include <span>
#include <unordered_set>
#include <vector>

#include "collar/feature_hierarchy.h"
#include "collarmesh/plc.h"
#include "collarmesh/plc_builder.h"
#include "collarmesh/surface_tolerance.h"
#include "common/edge_key.h"
#include "common/hierarchy.h"
#include "location/centred_box.h"

namespace collarmesh {

/// A ball on a crease (paper, Definition 7).
struct CollarBall {
  Point centre;
  double radius;
  std::uint8_t dimension;  ///< 0: at a crease vertex, 1: on a crease curve
  Index feature;           ///< index of that vertex or curve
};

/// Two consecutive balls of a crease; their spheres meet in a circle.
struct CollarLink {
  std::array<Index, 2> balls;
  Index curve;
  std::array<double, 2> parameters;  ///< arc lengths along the curve at the two centres
};

/// A point that the mesh must have for the collar surface to follow the features: where a patch meets the
/// circle of two consecutive balls or, around a crease vertex, the sphere of its ball.
struct CornerPoint {
  Point point;
  std::uint8_t dimension;  ///< 2: on a patch
  Index feature;
};

/// The options of the placement of balls: bounds on their size, a seed, and callbacks.
struct CollarOptions {
  /// Returns an upper bound on the radius of a ball at a place on a vertex or curve.
  std::function<double(const Feature&, const Point&)> size;
  /// The largest permitted distance between the cells inside a ball and the smooth curves and patches that
  /// they replace.
  SurfaceTolerance tolerance{0};
  std::uint64_t seed = 0;
  /// Called from time to time with a lower bound on the final number of balls; if it returns true, the system
  /// stays incomplete. May be empty.
  std::function<bool(std::size_t balls)> stopped = {};
  /// Returns whether a ball of this radius at a place is too small, because features there are too near to
  /// each other. May be empty.
  std::function<bool(const Point&, double)> too_small = {};
  /// Converts a place to input coordinates, for messages. May be empty.
  std::function<Point(const Point&)> outside = {};
};

/// The union of balls that covers every crease, with the corner points on its surface (paper, section 3.2).
/// Consecutive balls overlap deeply. Balls of two creases are disjoint unless one crease is an end of the
/// other.
class CollarSystem {
 public:
  CollarSystem() = default;
  /// Makes a system without balls for these creases; CollarPlacement places them. Keeps references to the
  /// complex and its points.
  CollarSystem(const Plc& plc, std::span<const Point> points, std::span<const Crease> creases);
  /// Places balls on all creases. Their radii are at most a third of the gap size and at most `options.size`,
  /// then shrunk by random shares of up to 2% (seeded), so that the spheres are in general position. On
  /// smooth curves and patches the balls are so small that the cells inside them stay within
  /// `options.tolerance`. Throws PlcError where a ball would be too small (`too_small`). Cost for n elements
  /// of the complex and b balls: O((n + b) log n).
  CollarSystem(const Plc& plc, std::span<const Point> points, std::span<const Crease> creases,
               const CollarOptions& options);

  bool empty() const { return balls_.empty(); }
  /// Returns the hierarchy of the complex's features. Precondition: the complex has creases.
  const FeatureHierarchy& features() const {
    assert(features_);
    return *features_;
  }
  const std::vector<CollarBall>& balls() const { return balls_; }
  const std::vector<CollarLink>& links() const { return links_; }
  const std::vector<CornerPoint>& corners() const { return corners_; }
  /// Returns the vertices that get a ball: those of creases and the ends of crease curves.
  const std::vector<Index>& crease_vertices() const { return crease_vertices_; }
  bool is_crease_vertex(Index vertex) const { return std::ranges::binary_search(crease_vertices_, vertex); }
  bool is_crease_curve(Index curve) const { return !crease_curve_.empty() && crease_curve_[curve]; }
  /// Returns the ball at a crease vertex; none if it has no ball yet or belongs to no crease.
  Index ball_at_vertex(Index vertex) const { return vertex_ball_.empty() ? none : vertex_ball_[vertex]; }
  /// Declares that no more balls will come, and builds one tree over all of them, regardless of their
  /// creases.
  void complete();
  bool consecutive(Index a, Index b) const { return consecutive_.count(edge_key(a, b)) > 0; }

  /// Returns a ball that contains p in its interior, or none. Several threads may call it at once while no
  /// balls are added.
  Index ball_containing(const Point& p) const;
  bool contains(Index ball, const Point& p) const {
    return squared_distance(p, balls_[ball].centre) < balls_[ball].radius * balls_[ball].radius;
  }
  /// Replaces `found` by the balls that meet the ball B(p, radius), but by at most `most` of them.
  void balls_meeting(const Point& p, double radius, std::size_t most, std::vector<Index>& found) const;
  /// Replaces `found` by the balls that meet the segment pq.
  void balls_on_segment(const Point& p, const Point& q, std::vector<Index>& found) const;

 private:
  /// Bounds of the balls of the creases below a node: a box for queries, and the exact box.
  struct OfCreases {
    CentredBox centred = CentredBox::empty();
    Box box;
    Index parent = none;

    OfCreases() = default;
    explicit OfCreases(const Box&) {}  // `Hierarchy::add` converts from a box
  };
  /// Builds the tree over creases, which may have no balls yet.
  void plant(const Plc& plc, std::span<const Point> points);
  /// Adds the balls placed since the last call to the trees that queries use. Precondition: all these balls
  /// are on `crease`.
  void index_balls(const Feature& crease);
  /// Builds a tree over all balls from number `first` on. Returns their box.
  Box build_over_balls(Index first);
  Index leaf_of(const Feature& crease) const {
    return leaves_[crease.index + (crease.dimension == 1 ? vertex_ball_.size() : 0)];
  }
  template <class Meets, class Visit>
  void visit(const Meets& meets_box, const Visit& visit_ball) const;

  std::unique_ptr<const FeatureHierarchy> features_;
  std::vector<CollarBall> balls_;
  std::vector<CollarLink> links_;
  std::vector<CornerPoint> corners_;
  std::vector<bool> crease_curve_;
  std::vector<Index> vertex_ball_;
  std::vector<Index> crease_vertices_;             // sorted
  std::unordered_set<std::uint64_t> consecutive_;  // keys of pairs of consecutive balls
  // Until `complete`, there is a tree over creases, and for each crease a tree over its balls; afterwards
  // there is one tree over all balls.
  Hierarchy<OfCreases> creases_;
  std::vector<Index> leaves_;  // leaf in `creases_`, by vertex, then by curve; none if no crease is there
  // By item of `creases_`, one per crease: root of the tree over the crease's balls, or none if it has no
  // balls.
  std::vector<Index> root_of_;
  Hierarchy<CentredBox> trees_;  // over balls
  Index indexed_ = 0;            // number of balls in trees

  friend class CollarPlacement;
};

}  // namespace collarmesh
