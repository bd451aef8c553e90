// The chains of curves: what guards them, how subsegments are split, what insertions tell them.
#include "refine/curve_chains.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

#include "support/plc_shapes.h"
#include "support/refinement_parts.h"

namespace collarmesh {
namespace {

/// Curves beside the parts they need; the test is the loop.
struct Curves : testing::KnownCurves {
  explicit Curves(const Plc& plc, double size) : KnownCurves(plc, options(size)) { chains.start(); }
  static MeshOptions options(double size) {
    MeshOptions o;
    o.size = size;
    return o;
  }

  void insert_and_tell(const Point& p, const Feature& feature = {3, none}) {
    const Index vertex = insert(p, feature);
    points.cells_made(zone, vertex);
    chains.cells_made(zone, vertex);
  }
  void resolve(Index point) {
    const UnresolvedPoints::Unresolved p = points[point];
    points.resolve(point, mesh.vertex_count());
    insert_and_tell(p.point, p.feature);
    chains.point_resolved(point);
  }
  void resolve_all() {
    for (Index point = 0; point < points.size(); ++point)
      if (!points.resolved(point)) resolve(point);
  }
  std::size_t count() const {
    std::size_t n = 0;
    chains.visit([&](Index, const Subsegment&) { ++n; });
    return n;
  }
  /// Split what is in the queue until nothing is. Returns how many were.
  std::size_t split_all() {
    std::size_t splits = 0;
    for (WorkQueue::Item item; queue.pop(item);) {
      const bool splits_one = item.priority == WorkQueue::encroached_subsegments ||
                              item.priority == WorkQueue::coarse_subsegments;
      if (!splits_one || !chains.due(item.entry)) continue;
      const auto split = chains.split_of(item.entry.id);
      if (!split || split->candidate.start == none) return none;
      chains.remove(*split);
      insert_and_tell(split->candidate.point, split->candidate.feature);
      chains.add_pieces(*split, mesh.last_vertex());
      ++splits;
    }
    return splits;
  }
  /// The number of the mesh vertices in a subsegment's ball.
  std::size_t encroaching(const Subsegment& s) const {
    std::size_t n = 0;
    for (Index v = 0; v < mesh.vertex_count(); ++v)
      n += v != s.ends[0] && v != s.ends[1] && squared_distance(mesh.point(v), s.centre) < s.squared_radius;
    return n;
  }
};

Plc box() {
  const PolygonSoup soup = testing::box({0, 0, 0}, {1, 1, 1});
  return build_plc({&soup, 1});
}

TEST(CurveChains, ACurveStartsWhenItsEndsAreInTheMesh) {
  const Plc plc = box();
  Curves curves(plc, 10);
  EXPECT_EQ(curves.points.size(), 8U);
  EXPECT_EQ(curves.count(), 0U);
  curves.resolve(plc.curves[0].ends[0]);
  EXPECT_EQ(curves.count(), 0U);
  curves.resolve(plc.curves[0].ends[1]);
  EXPECT_EQ(curves.count(), 1U);
  curves.chains.visit([&](Index, const Subsegment& s) {
    EXPECT_EQ(s.curve, 0U);
    EXPECT_NEAR(s.squared_radius, 0.25, 1e-12);
  });
  curves.resolve_all();
  EXPECT_EQ(curves.count(), 12U);
}

TEST(CurveChains, WhatEncroachesAWaitingCurveBringsItsEndsIn) {
  const Plc plc = box();
  Curves curves(plc, 10);
  const Point near = curves.points[plc.curves[0].ends[0]].point,
              far = curves.points[plc.curves[0].ends[1]].point;
  // Away from it at first: its ball is found from ever nearer vertices.
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> unit(-0.3, 1.3);
  for (int k = 0; k < 200; ++k) {
    const Point p{unit(random), unit(random), unit(random)};
    if (distance(p, 0.5 * (near + far)) > 0.5) curves.insert_and_tell(p);
  }
  curves.queue = WorkQueue(100);
  const Point intruder = near + 0.45 * (far - near);
  curves.find_zone(intruder);
  const Candidate candidate{intruder, 1, intruder, {3, none}, curves.zone.cells[0]};
  const Index ball = curves.chains.encroached(curves.zone, candidate);
  ASSERT_NE(ball, none);
  EXPECT_EQ(curves.chains.subsegment_of(ball), none);
  EXPECT_EQ(curves.chains.end_to_resolve(ball, intruder), plc.curves[0].ends[0]);
  // Inserted nevertheless it makes them come next.
  curves.insert_and_tell(intruder);
  std::set<Index> hurried;
  for (WorkQueue::Item item; curves.queue.pop(item);)
    if (item.priority == WorkQueue::ends_of_encroached_subsegments) hurried.insert(item.entry.id);
  EXPECT_TRUE(hurried.contains(plc.curves[0].ends[0]));
  EXPECT_TRUE(hurried.contains(plc.curves[0].ends[1]));
}

TEST(CurveChains, AVertexInABallQueuesItsSubsegmentAndNoOther) {
  const Plc plc = box();
  Curves curves(plc, 10);
  curves.resolve_all();
  EXPECT_EQ(curves.split_all(), 0U);
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> unit(-0.3, 1.3);
  for (int k = 0; k < 500; ++k) {
    const Point p{unit(random), unit(random), unit(random)};
    bool in_ball = false;
    curves.chains.visit([&](Index, const Subsegment& s) {
      in_ball = in_ball || squared_distance(p, s.centre) < 1.01 * s.squared_radius;
    });
    if (!in_ball) curves.insert_and_tell(p);
  }
  EXPECT_EQ(curves.split_all(), 0U);
  curves.insert_and_tell({0.5, 0.2, 0.1});
  std::size_t encroached = 0;
  curves.chains.visit([&](Index, const Subsegment& s) { encroached += curves.encroaching(s) > 0; });
  EXPECT_GT(encroached, 0U);
  std::set<Index> queued;
  for (WorkQueue::Item item; curves.queue.pop(item);)
    if (item.priority == WorkQueue::encroached_subsegments) queued.insert(item.entry.id);
  EXPECT_EQ(queued.size(), encroached);
}

TEST(CurveChains, SplittingEndsWithEmptyBallsAndFineSubsegments) {
  const Plc plc = box();
  const double size = 0.2;
  Curves curves(plc, size);
  curves.resolve_all();
  EXPECT_GT(curves.split_all(), 40U);
  curves.insert_and_tell({0.5, 0.02, 0.01});
  EXPECT_GT(curves.split_all(), 0U);
  std::vector<double> covered(plc.curves.size(), 0);
  curves.chains.visit([&](Index, const Subsegment& s) {
    EXPECT_EQ(curves.encroaching(s), 0U);
    const double length = distance(curves.mesh.point(s.ends[0]), curves.mesh.point(s.ends[1]));
    EXPECT_LE(length, Sizing::subsegment_length(Sizing::edge_per_size * size));
    EXPECT_NEAR(length, s.parameters[1] - s.parameters[0], 1e-9);
    covered[s.curve] += length;
  });
  for (const double length : covered) EXPECT_NEAR(length, 1, 1e-9);
  EXPECT_FALSE(curves.outcome.given_up());
}

TEST(CurveChains, CoarseOnesComeAfterQuality) {
  const Plc plc = box();
  Curves curves(plc, 0.2);
  curves.resolve_all();
  std::set<unsigned> priorities;
  for (WorkQueue::Item item; curves.queue.pop(item);) priorities.insert(item.priority);
  EXPECT_TRUE(priorities.contains(WorkQueue::coarse_subsegments));
  EXPECT_FALSE(priorities.contains(WorkQueue::encroached_subsegments));
  static_assert(WorkQueue::coarse_subsegments > WorkQueue::skinny_cells);
}

TEST(CurveChains, ABallAtTheFloorIsGivenUp) {
  const Plc plc = box();
  Curves curves(plc, 10);
  curves.resolve_all();
  Index some = none;
  curves.chains.visit([&](Index s, const Subsegment&) { some = s; });
  for (int k = 0; k < 200 && !curves.outcome.given_up(); ++k) {
    const auto split = curves.chains.split_of(some);
    if (!split) break;
    ASSERT_NE(split->candidate.start, none);
    curves.chains.remove(*split);
    curves.insert_and_tell(split->candidate.point, split->candidate.feature);
    curves.chains.add_pieces(*split, curves.mesh.last_vertex());
    double smallest = INFINITY;
    curves.chains.visit([&](Index s, const Subsegment& piece) {
      if (piece.squared_radius < smallest) some = s;
      smallest = std::min(smallest, piece.squared_radius);
    });
  }
  EXPECT_TRUE(curves.outcome.given_up());
}

}  // namespace
}  // namespace collarmesh
