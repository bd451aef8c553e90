// The parts that make collars and judge surfaces; the test does the work of the refinement loop.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include "refine/collar_review.h"
#include "refine/rip_and_stitch.h"
#include "refine/surface_check.h"
#include "refine/surface_topology.h"
#include "support/acute_shapes.h"
#include "support/plc_shapes.h"
#include "support/polylines.h"
#include "support/refinement_parts.h"

namespace collarmesh::collar_parts_test {
namespace {

struct Parts : testing::KnownCurves {
  explicit Parts(const Plc& plc, const MeshOptions& options = with(CollarCreation::up_front))
      : KnownCurves(plc, options) {
    creator.start();
    chains.start();
  }

  static MeshOptions with(CollarCreation creation) {
    MeshOptions options;
    options.collar_creation = creation;
    return options;
  }

  void insert_and_tell(const Point& p, const Feature& feature) {
    const Index vertex = insert(p, feature);
    points.cells_made(zone, vertex);
    chains.cells_made(zone, vertex);
    triangles.cells_made(zone);
    collar_surface.cells_made(zone);
    review.cells_made(zone);
  }
  void resolve_all() {
    for (Index point = 0; point < points.size(); ++point) {
      if (points.resolved(point)) continue;
      const UnresolvedPoints::Unresolved p = points[point];
      points.resolve(point, mesh.vertex_count());
      insert_and_tell(p.point, p.feature);
      chains.point_resolved(point);
    }
  }
  void resolve_vertex_with_ball(Index vertex) {
    const Point p = points[vertex].point;
    points.resolve(vertex, mesh.vertex_count());
    insert_and_tell(p, {0, vertex});
    creator.create_at_vertex(vertex, mesh.last_vertex(), BallReason::vertex_inserted);
    chains.point_resolved(vertex);
  }
  // Splits all subsegments whose balls contain vertices, as the refinement loop does.
  void split_encroached() {
    WorkQueue::Item item;
    while (queue.first_priority() == WorkQueue::encroached_subsegments && queue.pop(item))
      if (chains.is_due(item.entry) && !creator.create_at_subsegment(item.entry.id))
        chains.split_ahead(*chains.split_of(item.entry.id));
  }
  // Returns the pieces of a curve as ranges of its parameter, sorted.
  std::vector<std::array<double, 2>> pieces_of(Index curve) const {
    std::vector<std::array<double, 2>> pieces;
    chains.visit([&](Index, const Subsegment& s) {
      if (s.curve == curve) pieces.push_back(s.parameters);
    });
    std::sort(pieces.begin(), pieces.end());
    return pieces;
  }
  // Returns the radius of the ball whose sphere a point lies on.
  double radius_around(const Point& p) const {
    const auto off = [&](const CollarBall& ball) {
      return std::fabs(distance(p, ball.centre) / ball.radius - 1);
    };
    const auto& balls = collars.balls();
    const auto nearest = std::min_element(balls.begin(), balls.end(),
                                          [&](const auto& a, const auto& b) { return off(a) < off(b); });
    EXPECT_LT(off(*nearest), 1e-6);
    return nearest->radius;
  }
  // Repairs all queued faults. Repairs keep a distance from all vertices, so this ends.
  void mend_what_is_queued() {
    for (WorkQueue::Item item; queue.pop(item);) {
      if (item.priority != WorkQueue::exposed_crease_vertices &&
          item.priority != WorkQueue::poor_collar_triangles)
        continue;
      const auto candidate = review.candidate(item);
      if (!candidate) continue;
      EXPECT_TRUE(mesh.in_conflict(candidate->start, candidate->point));
      EXPECT_GE(distance(candidate->point, mesh.point(mesh.nearest_vertex(candidate->point))),
                1e-3 * radius_around(candidate->point));
      ++repairs;
      insert_and_tell(candidate->point, candidate->feature);
    }
  }
  std::set<Index> queued_triangles() {
    std::set<Index> found;
    for (WorkQueue::Item item; queue.pop(item);)
      if (item.priority == WorkQueue::unresolved_triangles && triangles.is_due(item.entry))
        found.insert(item.entry.id);
    return found;
  }

  std::size_t repairs = 0;
  TriangleQuality triangles{domain, mesh, nodes, surface, sizes, facing_sheets, random, queue};
  CollarCreator creator{domain,
                        mesh,
                        nodes,
                        sizes,
                        collars,
                        collar_cells,
                        surface,
                        points,
                        chains,
                        open_creases,
                        [](std::size_t) { return false; }};
  CollarSurface collar_surface{domain, mesh, nodes, collars, collar_cells, surface, creator};
  CollarReview review{mesh,    collars,        collar_cells, surface,
                      creator, collar_surface, queue,        [] { return false; }};
  SurfaceCheck check{domain, mesh, nodes, collars, collar_cells, surface, triangles, points, chains, outcome};
};

Plc build(const PolygonSoup& soup) { return build_plc({&soup, 1}); }

TEST(CollarParts, EveryBallHasItsCentreAndEveryCornerAPoint) {
  const Plc plc = build(testing::wedge(25, 1));
  Parts parts(plc);
  ASSERT_FALSE(parts.collars.empty());
  EXPECT_EQ(parts.creator.vertex_of(0), none);
  parts.resolve_all();
  for (Index ball = 0; ball < parts.collars.balls().size(); ++ball) {
    const CollarBall& b = parts.collars.balls()[ball];
    const Index v = parts.creator.vertex_of(ball);
    ASSERT_NE(v, none);
    EXPECT_EQ(parts.mesh.point(v), b.centre);
    EXPECT_EQ(parts.mesh.feature(v), (Feature{b.dimension, b.feature}));
    EXPECT_TRUE(parts.collar_surface.on_crease(v));
  }
  for (const CornerPoint& corner : parts.collars.corners()) {
    const Index v = parts.mesh.nearest_vertex(corner.point);
    EXPECT_NEAR(distance(parts.mesh.point(v), corner.point), 0, 1e-9);
    EXPECT_LE(parts.mesh.feature(v).dimension, corner.dimension);
  }
}

TEST(CollarParts, InThePassNoBallIsPlacedAtTheStart) {
  const Plc plc = build(testing::wedge(25, 1));
  Parts parts(plc, Parts::with(CollarCreation::in_pass));
  EXPECT_TRUE(parts.collars.empty());
  const std::vector<Index> open = parts.open_creases.curves();
  ASSERT_FALSE(open.empty());
  const Index end = plc.curves[open[0]].ends[0];
  EXPECT_TRUE(parts.creator.waits_for_ball(end));
  std::size_t observed = 0;
  parts.creator.observe([&](const CollarBall& ball) {
    EXPECT_EQ(ball.feature, end);
    ++observed;
  });
  const Point p = parts.points[end].point;
  parts.points.resolve(end, parts.mesh.vertex_count());
  parts.insert_and_tell(p, {0, end});
  parts.creator.create_at_vertex(end, parts.mesh.last_vertex(), BallReason::vertex_inserted);
  EXPECT_EQ(observed, 1U);
  EXPECT_FALSE(parts.creator.waits_for_ball(end));
  EXPECT_NE(parts.open_creases.chain(open[0]).ends[0], none);  // the point where the crease leaves the ball
  EXPECT_TRUE(parts.collar_cells.near(parts.mesh.last_vertex()));
}

// A subsegment that would be split is replaced by the balls of its crease.
TEST(CollarParts, ACreaseGetsItsBallsInsteadOfASplit) {
  const Plc plc = build(testing::wedge(25, 1));
  Parts parts(plc, Parts::with(CollarCreation::in_pass));
  const Index curve = parts.open_creases.curves().at(0);
  for (const Index end : plc.curves[curve].ends) parts.resolve_vertex_with_ball(end);
  const auto& chain = parts.open_creases.chain(curve);
  EXPECT_GT(chain.unresolved, 0U);  // there are no vertices yet where the crease leaves its balls
  for (const Index point : std::array<Index, 2>(chain.ends)) {
    const UnresolvedPoints::Unresolved p = parts.points[point];
    parts.points.resolve(point, parts.mesh.vertex_count());
    parts.insert_and_tell(p.point, p.feature);
    parts.chains.point_resolved(point);
  }
  std::vector<Index> subsegments;
  parts.chains.visit([&](Index s, const Subsegment& piece) {
    if (piece.curve == curve) subsegments.push_back(s);
  });
  ASSERT_FALSE(subsegments.empty());
  const std::size_t before = parts.collars.balls().size();
  EXPECT_TRUE(parts.creator.create_at_subsegment(subsegments[0]));
  EXPECT_GT(parts.collars.balls().size(), before);
  EXPECT_FALSE(parts.open_creases.is_open(curve));
  parts.chains.visit([&](Index, const Subsegment& piece) { EXPECT_NE(piece.curve, curve); });
}

// A crease that was split while its ends were missing gets its balls as soon as its ends are there; the
// points that split it are removed.
TEST(CollarParts, ACreaseThatIsSplitAheadGetsItsBallsWhenItsEndsAreThere) {
  const Plc plc = build(testing::wedge(25, 1));
  Parts parts(plc, Parts::with(CollarCreation::in_pass));
  const Index curve = parts.open_creases.curves().at(0);
  const double length = parts.domain.paths.length(curve);
  parts.insert_and_tell(parts.domain.paths.point(curve, 0.45 * length) + Vector{-0.05, 0.01, 0}, {3, none});
  parts.split_encroached();
  EXPECT_GT(parts.pieces_of(curve).size(), 2U);
  EXPECT_TRUE(parts.open_creases.chain(curve).split);
  for (const Index end : plc.curves[curve].ends) parts.resolve_vertex_with_ball(end);
  for (const Index point : std::array<Index, 2>(parts.open_creases.chain(curve).ends)) {
    const UnresolvedPoints::Unresolved p = parts.points[point];
    parts.points.resolve(point, parts.mesh.vertex_count());
    parts.insert_and_tell(p.point, p.feature);
    parts.chains.point_resolved(point);
  }
  parts.split_encroached();
  EXPECT_FALSE(parts.open_creases.is_open(curve));
  EXPECT_TRUE(parts.pieces_of(curve).empty());
  for (Index point = 0; point < parts.points.size(); ++point)
    if (parts.points[point].dormant) {
      EXPECT_EQ(parts.points[point].object, none);
    }
}

TEST(CollarParts, AChainThatIsSplitBeginsOnTheSphereOfTheBallAtItsEnd) {
  const Plc plc = build(testing::polylines::skew_zigzags(16, 40).soups[0]);
  const auto creases = find_creases(plc, 60);
  ASSERT_FALSE(creases.empty());
  for (const double away : {0.01, 0.1, 0.3, 0.5}) {
    SCOPED_TRACE(away);
    Parts parts(plc, Parts::with(CollarCreation::in_pass));
    const Index vertex = creases[0].vertex;
    const Index curve = plc.vertices[vertex].curves.at(0);
    const double length = parts.domain.paths.length(curve);
    const bool at_start = plc.curves[curve].ends[0] == vertex;
    const double near = at_start ? away * length : (1 - away) * length;
    const Vector aside{0, 0, 0.2 * away * length};
    parts.insert_and_tell(parts.domain.paths.point(curve, near) + aside, {3, none});
    parts.split_encroached();
    EXPECT_GT(parts.pieces_of(curve).size(), 2U);
    parts.resolve_vertex_with_ball(vertex);
    const CollarBall ball = parts.collars.balls().back();
    const auto pieces = parts.pieces_of(curve);
    ASSERT_FALSE(pieces.empty());
    for (std::size_t i = 1; i < pieces.size(); ++i) EXPECT_EQ(pieces[i - 1][1], pieces[i][0]);
    EXPECT_NEAR(at_start ? pieces.front()[0] : length - pieces.back()[1], ball.radius, 1e-9);
    EXPECT_NEAR(at_start ? pieces.back()[1] : pieces.front()[0], at_start ? length : 0, 1e-9);
    for (Index point = 0; point < parts.points.size(); ++point) {
      const UnresolvedPoints::Unresolved& p = parts.points[point];
      if (p.object != none && p.feature.dimension == 1 && p.feature.index == curve) {
        EXPECT_GT(distance(p.point, ball.centre), ball.radius * (1 - 1e-9));
      }
    }
    const double shortest =
        at_start ? pieces.front()[1] - pieces.front()[0] : pieces.back()[1] - pieces.back()[0];
    EXPECT_GT(shortest, 0.25 * ball.radius);
  }
}

// The explorer first tests the feature that was nearest last time; this must not change any answer.
TEST(CollarParts, ExplorersThatRememberAnswerAsThoseThatDoNot) {
  std::size_t isolated = 0, others = 0;
  for (const auto& shape : {testing::acute::lens(40), testing::acute::star_prism(9, 0.4)}) {
    SCOPED_TRACE(shape.name);
    PlcOptions complex;
    complex.feature_angle = shape.feature_angle;
    const Plc plc = build_plc(shape.soups, complex);
    testing::KnownMesh known(plc);
    GapExplorer remembers(known.domain, known.mesh, known.nodes);
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> unit(-1, 1);
    for (int k = 0; k < 300; ++k) {
      const Plc::Triangle& t = plc.triangles[random() % plc.triangles.size()];
      const Vector offset{unit(random), unit(random), unit(random)};
      const Point p = known.domain.points[t.points[random() % 3]] + 1e-3 * offset;
      known.insert(p);
      GapExplorer fresh(known.domain, known.mesh, known.nodes);
      const bool at_vertex = !plc.vertices.empty() && k % 2 == 0;
      const auto index = static_cast<Index>(random() % (at_vertex ? plc.vertices.size() : plc.curves.size()));
      const Feature at{static_cast<std::uint8_t>(at_vertex ? 0 : 1), index};
      const Point x =
          known.domain.points[at_vertex ? plc.vertices[index].point : plc.curves[index].points[1]];
      const auto gap = [&](GapExplorer& explorer) {
        return at_vertex ? explorer.at_vertex(index) : explorer.on_curve(index, x);
      };
      EXPECT_EQ(gap(remembers), gap(fresh));
      const Index cell = known.mesh.nearest_vertex(x);
      EXPECT_EQ(remembers.isolated(at, cell), fresh.isolated(at, cell));
      if (remembers.isolated(at, cell)) {
        ++isolated;
      } else {
        ++others;
        EXPECT_TRUE(remembers.witness_remains(at));
      }
    }
  }
  EXPECT_GT(isolated, 10U);
  EXPECT_GT(others, 10U);
}

TEST(CollarParts, RepairsEndWithACollarSurfaceThatCanBeStitched) {
  const Plc plc = build(testing::wedge(25, 1));
  Parts parts(plc);
  parts.resolve_all();
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> unit(-0.1, 1.1);
  std::size_t looks = 0;
  for (int again = 0; again < 3; ++again) {  // triangles that were good may become poor
    for (int k = 0; k < 200; ++k) {
      const double share = k < 100 ? 1 : 0.2;  // positions across the wedge, from its edge
      const Point p{share * unit(random), share * 0.5 * unit(random), unit(random)};
      const Index v = parts.mesh.nearest_vertex(p);
      if (parts.collars.ball_containing(p) == none && distance(p, parts.mesh.point(v)) > 0.02)
        parts.insert_and_tell(p, {3, none});
      for (const Index cell : parts.zone.created)
        for (unsigned corner = 0; corner < 4 && parts.mesh.alive(cell); ++corner)
          EXPECT_FALSE(parts.collar_surface.is_off(face_id(cell, corner)));  // nothing has been asked yet
    }
    for (parts.mend_what_is_queued(); parts.review.check(); parts.mend_what_is_queued()) ++looks;
  }
  EXPECT_GT(looks, 0U);
  EXPECT_FALSE(parts.outcome.given_up()) << parts.outcome.message();
  std::vector<Index> balls;
  for (Index cell = 0; cell < parts.mesh.cell_capacity(); ++cell)
    for (unsigned corner = 0; corner < 4 && parts.mesh.alive(cell); ++corner) {
      const FaceId face = face_id(cell, corner), other = parts.mesh.opposite(face);
      if (other == no_face || !parts.collar_surface.is_off(face)) continue;
      parts.collars.balls_on_segment(parts.mesh.circumcentre(cell), parts.mesh.circumcentre(cell_of(other)),
                                     balls);
      EXPECT_TRUE(balls.empty());
    }
  std::size_t inside = 0;
  for (CollarTriangle t : parts.collar_surface.triangles()) {
    if (parts.surface.region(cell_of(t.face)) == 0) continue;
    ++inside;
    EXPECT_FALSE(parts.collar_surface.poor_alone(t));
    EXPECT_FALSE(t.several);
    for (const Index v : parts.mesh.face_vertices(t.face)) EXPECT_FALSE(parts.collar_surface.on_crease(v));
  }
  EXPECT_GT(inside, 10U);
  // Since nothing was inserted, the answer is known already.
  EXPECT_FALSE(parts.review.check());
  RipAndStitch stitching(parts.domain, parts.mesh, parts.nodes, parts.collars, parts.surface, parts.points,
                         parts.chains, parts.creator, parts.collar_surface);
  stitching.stitch();
  const auto& tets = stitching.result().tets;
  EXPECT_EQ(static_cast<std::size_t>(
                std::count_if(tets.begin(), tets.end(), [](const auto& tet) { return tet.collar == 1; })),
            inside);
  EXPECT_GT(tets.size(), inside);  // the stitching also makes books
  for (const auto& tet : tets) {
    const auto& v = tet.corners;
    EXPECT_GT(six_volume(parts.mesh.point(v[0]), parts.mesh.point(v[1]), parts.mesh.point(v[2]),
                         parts.mesh.point(v[3])),
              0);
  }
  EXPECT_EQ(stitching.result().edges.size(),
            parts.collars.links().size() + parts.chains.clipped_ends().size());
}

// Two smooth patches pass through each ball at the rim.
TEST(CollarParts, RepairsAtASmoothCreaseEnd) {
  const testing::acute::Shape lens = testing::acute::lens(40);
  const Plc plc = build_plc(lens.soups);
  MeshOptions options = Parts::with(CollarCreation::up_front);
  options.size = 0.5;
  Parts parts(plc, options);
  parts.resolve_all();
  ASSERT_FALSE(parts.collars.empty());
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int k = 0; k < 400; ++k) {
    const auto pick = [&](double low, double high) { return low + (high - low) * unit(random); };
    const Point p{pick(plc.bounds.min.x, plc.bounds.max.x), pick(plc.bounds.min.y, plc.bounds.max.y),
                  pick(plc.bounds.min.z, plc.bounds.max.z)};
    if (parts.collars.ball_containing(p) == none &&
        distance(p, parts.mesh.point(parts.mesh.nearest_vertex(p))) > 0.02)
      parts.insert_and_tell(p, {3, none});
  }
  for (parts.mend_what_is_queued(); parts.review.check(); parts.mend_what_is_queued()) {
  }
  EXPECT_GT(parts.repairs, 0U);
  EXPECT_FALSE(parts.review.check());
}

TEST(CollarParts, WithoutCreasesThereIsNothingToReview) {
  const Plc plc = build(testing::polygonal_box({0, 0, 0}, {1, 1, 1}));
  Parts parts(plc);
  parts.resolve_all();
  EXPECT_TRUE(parts.collars.empty());
  EXPECT_FALSE(parts.review.check());
  EXPECT_TRUE(parts.collar_surface.triangles().empty());
}

TEST(SurfaceParts, AClosedPatchIsSeededAndAMissedOneMore) {
  const Plc plc = build(testing::sphere(6, 1, {0, 0, 0}));
  Parts parts(plc);
  ASSERT_EQ(plc.patches.size(), 1U);
  EXPECT_EQ(parts.points.size(), 0U);
  parts.check.seed_closed_patches();
  const std::size_t seeds = parts.points.size();
  EXPECT_GT(seeds, 3U);
  for (Index point = 0; point < seeds; ++point) EXPECT_EQ(parts.points[point].feature, (Feature{2, 0}));
  EXPECT_TRUE(parts.check.check());  // the patch has no triangle yet
  EXPECT_GT(parts.points.size(), 2 * seeds);
}

TEST(SurfaceParts, WhatIsFarFromASmoothPatchIsSplitUntilNothingIs) {
  const Plc plc = build(testing::sphere(12, 1, {0, 0, 0}));
  MeshOptions options;
  options.bounds.distance = 0.1;
  Parts parts(plc, options);
  parts.check.seed_closed_patches();
  parts.resolve_all();
  std::size_t rounds = 0;
  while (parts.check.check() && ++rounds < 50) {
    parts.resolve_all();
    for (const FaceId face : parts.queued_triangles()) {
      if (!parts.mesh.alive(cell_of(face)) || !parts.surface.is_marked(face)) continue;
      const auto candidate = parts.triangles.candidate(face);
      if (candidate) parts.insert_and_tell(candidate->point, candidate->feature);
    }
  }
  EXPECT_GT(rounds, 0U);
  EXPECT_LT(rounds, 50U);
  for (const Point& p : parts.domain.points) {
    double nearest = INFINITY;
    for (const FaceId face : parts.surface.marked_faces()) {
      const auto v = parts.mesh.face_vertices(face);
      nearest =
          std::min(nearest, squared_distance_to_triangle(p, parts.mesh.point(v[0]), parts.mesh.point(v[1]),
                                                         parts.mesh.point(v[2])));
    }
    EXPECT_LE(std::sqrt(nearest), options.bounds.distance);
  }
}

TEST(SurfaceParts, SpreadPointsAreFarFromEachOther) {
  std::vector<Point> points;
  std::vector<Index> all;
  for (Index i = 0; i < 11; ++i) {
    points.push_back({0.1 * i, 0, 0});
    all.push_back(i);
  }
  EXPECT_EQ(spread_points(all, points, 3), (std::vector<Index>{0, 10, 5}));
  EXPECT_EQ(spread_points(all, points, 20).size(), 11U);
  EXPECT_EQ(spread_points(std::vector<Index>{4, 4, 4}, points, 2), std::vector<Index>{4});
}

TEST(SurfaceParts, RoundsAreBounded) {
  const Plc plc = build(testing::polygonal_box({0, 0, 0}, {1, 1, 1}));
  Parts parts(plc);
  std::size_t rounds = 0;
  while (parts.check.another_round()) ASSERT_LT(++rounds, 1000U);
  EXPECT_GT(rounds, 10U);
  EXPECT_TRUE(parts.outcome.given_up());
  EXPECT_FALSE(parts.check.check());
}

}  // namespace
}  // namespace collarmesh::collar_parts_test
