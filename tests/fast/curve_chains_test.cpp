// The chains of curves: encroachment, splits, and the effects of insertions.
#include "refine/curve_chains.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include "support/plc_shapes.h"
#include "support/refinement_parts.h"

namespace collarmesh::curve_chains_test {
namespace {

/// Curves with the parts that they need; the test does the work of the refinement loop.
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
  std::size_t count(bool resolved) const {
    std::size_t n = 0;
    chains.visit([&](Index, const Subsegment& s) { n += s.resolved() == resolved ? 1 : 0; });
    return n;
  }
  std::size_t count() const { return count(true) + count(false); }
  /// Handles all entries of the queue, as the refinement loop does. Returns the number of splits.
  std::size_t work_off() {
    std::size_t splits = 0;
    for (WorkQueue::Item item; queue.pop(item);) {
      if (item.priority == WorkQueue::unresolved_points) {
        if (points.is_due(item.entry.id, item.entry.stamp)) resolve(item.entry.id);
      } else if (chains.is_due(item.entry)) {
        const auto split = chains.split_of(item.entry.id);
        if (!split || split->candidate.start == none) return none;
        if (item.priority == WorkQueue::encroached_subsegments)
          chains.split_ahead(*split);
        else
          insert_at(*split);
        ++splits;
      }
    }
    return splits;
  }
  void insert_at(const CurveChains::Split& split) {
    chains.drop_ball(split);
    insert_and_tell(split.candidate.point, split.candidate.feature);
    chains.split_at(split, mesh.last_vertex());
  }
  /// Returns the number of entries of each kind in the queue, and empties it.
  std::size_t queued(WorkQueue::Priority priority) {
    std::set<Index> found;
    for (WorkQueue::Item item; queue.pop(item);)
      if (item.priority == priority && chains.is_due(item.entry)) found.insert(item.entry.id);
    return found.size();
  }
  Point end_of(const Subsegment& s, unsigned side) const {
    if (s.ends[side] != none) return mesh.point(s.ends[side]);
    return domain.paths.point(s.curve, s.parameters[side]);
  }
  /// Returns the number of mesh vertices in a subsegment's ball.
  std::size_t encroaching(const Subsegment& s) const {
    std::size_t n = 0;
    for (Index v = 0; v < mesh.vertex_count(); ++v)
      n += mesh.point(v) != end_of(s, 0) && mesh.point(v) != end_of(s, 1) &&
           squared_distance(mesh.point(v), s.centre) < s.squared_radius;
    return n;
  }
  /// Expects that each curve without balls consists of its subsegments, with equal points where they meet.
  void expect_covered(double length) const {
    std::vector<std::vector<std::pair<double, double>>> pieces(domain.plc.curves.size());
    chains.visit([&](Index, const Subsegment& s) {
      pieces[s.curve].push_back({s.parameters[0], s.parameters[1]});
    });
    for (auto& of_curve : pieces) {
      std::sort(of_curve.begin(), of_curve.end());
      double covered = 0;
      for (std::size_t i = 0; i < of_curve.size(); ++i) {
        if (i > 0) {
          EXPECT_EQ(of_curve[i].first, of_curve[i - 1].second);
        }
        covered += of_curve[i].second - of_curve[i].first;
      }
      EXPECT_NEAR(covered, length, 1e-9);
    }
  }
};

Plc unit_box() {
  const PolygonSoup soup = testing::polygonal_box({0, 0, 0}, {1, 1, 1});
  return build_plc({&soup, 1});
}

TEST(CurveChains, ASubsegmentIsResolvedWhenItsEndsAreInTheMesh) {
  const Plc plc = unit_box();
  Curves curves(plc, 10);
  EXPECT_EQ(curves.points.size(), 8U);
  EXPECT_EQ(curves.count(false), 12U);
  curves.resolve(plc.curves[0].ends[0]);
  EXPECT_EQ(curves.count(true), 0U);
  curves.resolve(plc.curves[0].ends[1]);
  EXPECT_EQ(curves.count(true), 1U);
  curves.chains.visit([&](Index, const Subsegment& s) {
    if (s.resolved()) {
      EXPECT_EQ(s.curve, 0U);
    }
    EXPECT_NEAR(s.squared_radius, 0.25, 1e-12);
  });
  curves.resolve_all();
  EXPECT_EQ(curves.count(true), 12U);
}

// If ends encroached their own subsegments, the whole skeleton would be inserted at once, one end after the
// other.
TEST(CurveChains, TheirOwnEndsEncroachNoSubsegments) {
  const Plc plc = unit_box();
  Curves curves(plc, 10);
  for (Index point = 0; point < 8; ++point) {
    curves.resolve(point);
    EXPECT_EQ(curves.queued(WorkQueue::encroached_subsegments), 0U);
  }
}

TEST(CurveChains, ACandidateThatEncroachesAnUnresolvedOneMakesWayForAMedialEnd) {
  const Plc plc = unit_box();
  Curves curves(plc, 10);
  const Point near = curves.points[plc.curves[0].ends[0]].point,
              far = curves.points[plc.curves[0].ends[1]].point;
  // Inserts vertices around the edge, none of them in its ball. The ball is found from ever nearer vertices.
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> unit(-0.3, 1.3);
  for (int k = 0; k < 200; ++k) {
    const Point p{unit(random), unit(random), unit(random)};
    if (distance(p, 0.5 * (near + far)) > 0.6) curves.insert_and_tell(p);
  }
  const Point intruder = near + 0.45 * (far - near);
  curves.find_zone(intruder);
  const Candidate candidate{intruder, 1, intruder, {3, none}, curves.zone.cells[0]};
  const Index subsegment = curves.chains.encroached(curves.zone, candidate);
  ASSERT_NE(subsegment, none);
  EXPECT_EQ(curves.chains.curve_of(subsegment), 0U);
  EXPECT_EQ(curves.chains.end_to_resolve(subsegment, candidate), plc.curves[0].ends[0]);
  // Puts a vertex beside each end, so that the end is a bad place for a mesh vertex.
  curves.insert_and_tell(near + 1e-4 * (near - far));
  EXPECT_EQ(curves.chains.end_to_resolve(subsegment, candidate), plc.curves[0].ends[1]);
  curves.insert_and_tell(far + 1e-4 * (far - near));
  EXPECT_EQ(curves.chains.end_to_resolve(subsegment, candidate), none);
}

// Splitting ahead inserts no vertices, because the mesh may have skinny cells.
TEST(CurveChains, WhatAVertexEncroachesIsSplitAheadOfTheMesh) {
  const Plc plc = unit_box();
  Curves curves(plc, 10);
  curves.insert_and_tell({0.3, 0.02, 0.01});
  const Index vertices = curves.mesh.vertex_count();
  WorkQueue::Item item;
  std::size_t splits = 0;
  for (; curves.queue.first_priority() == WorkQueue::encroached_subsegments; ++splits) {
    if (curves.queue.pop(item) && curves.chains.is_due(item.entry))
      curves.chains.split_ahead(*curves.chains.split_of(item.entry.id));
  }
  EXPECT_GT(splits, 3U);
  EXPECT_EQ(curves.mesh.vertex_count(), vertices);
  curves.chains.visit([&](Index, const Subsegment& s) { EXPECT_EQ(curves.encroaching(s), 0U); });
  curves.expect_covered(1);
  curves.work_off();
  EXPECT_EQ(curves.count(false), 0U);
  EXPECT_GE(curves.count(true), 12U + 4U);
  curves.expect_covered(1);
}

TEST(CurveChains, AVertexInABallQueuesItsSubsegmentAndNoOther) {
  const Plc plc = unit_box();
  Curves curves(plc, 10);
  curves.resolve_all();
  EXPECT_EQ(curves.work_off(), 0U);
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
  EXPECT_EQ(curves.work_off(), 0U);
  curves.insert_and_tell({0.5, 0.2, 0.1});
  std::size_t encroached = 0;
  curves.chains.visit([&](Index, const Subsegment& s) { encroached += curves.encroaching(s) > 0; });
  EXPECT_GT(encroached, 0U);
  EXPECT_EQ(curves.queued(WorkQueue::encroached_subsegments), encroached);
}

TEST(CurveChains, SplittingEndsWithEmptyBallsAndFineSubsegments) {
  const Plc plc = unit_box();
  const double size = 0.2;
  Curves curves(plc, size);
  curves.resolve_all();
  EXPECT_GT(curves.work_off(), 40U);
  curves.insert_and_tell({0.5, 0.02, 0.01});
  EXPECT_GT(curves.work_off(), 0U);
  curves.chains.visit([&](Index, const Subsegment& s) {
    EXPECT_EQ(curves.encroaching(s), 0U);
    const double length = distance(curves.mesh.point(s.ends[0]), curves.mesh.point(s.ends[1]));
    EXPECT_LE(length, Sizing::subsegment_length(Sizing::edge_per_size * size));
    EXPECT_NEAR(length, s.parameters[1] - s.parameters[0], 1e-9);
  });
  curves.expect_covered(1);
  EXPECT_FALSE(curves.outcome.given_up());
}

TEST(CurveChains, CoarseOnesComeAfterQuality) {
  const Plc plc = unit_box();
  Curves curves(plc, 0.2);
  curves.resolve_all();
  std::set<unsigned> priorities;
  for (WorkQueue::Item item; curves.queue.pop(item);) priorities.insert(item.priority);
  EXPECT_TRUE(priorities.contains(WorkQueue::coarse_subsegments));
  EXPECT_FALSE(priorities.contains(WorkQueue::encroached_subsegments));
  static_assert(WorkQueue::coarse_subsegments > WorkQueue::skinny_cells);
}

TEST(CurveChains, ABallAtTheFloorIsGivenUp) {
  const Plc plc = unit_box();
  Curves curves(plc, 10);
  curves.resolve_all();
  Index some = none;
  curves.chains.visit([&](Index s, const Subsegment&) { some = s; });
  for (int k = 0; k < 200 && !curves.outcome.given_up(); ++k) {
    const auto split = curves.chains.split_of(some);
    if (!split) break;
    ASSERT_NE(split->candidate.start, none);
    curves.insert_at(*split);
    double smallest = INFINITY;
    curves.chains.visit([&](Index s, const Subsegment& piece) {
      if (piece.squared_radius < smallest) some = s;
      smallest = std::min(smallest, piece.squared_radius);
    });
  }
  EXPECT_TRUE(curves.outcome.given_up());
}

}  // namespace
}  // namespace collarmesh::curve_chains_test
