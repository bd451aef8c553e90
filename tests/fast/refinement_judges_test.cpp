// The parts of the refinement that judge: queued cells and triangles, cells that fill gaps, target sizes,
// cells in collars.
#include <gtest/gtest.h>

#include <array>
#include <random>
#include <set>

#include "refine/cell_quality.h"
#include "refine/triangle_quality.h"
#include "support/plc_shapes.h"
#include "support/refinement_parts.h"

namespace collarmesh::refinement_judges_test {
namespace {

using testing::KnownMesh;

Plc unit_box() {
  const PolygonSoup soup = testing::polygonal_box({0, 0, 0}, {1, 1, 1});
  return build_plc({&soup, 1});
}

MeshOptions with_size(double size) {
  MeshOptions options;
  options.size = size;
  return options;
}

/// All parts that judge cells and triangles.
struct Judges : KnownMesh {
  Judges(const Plc& plc, const MeshOptions& options) : KnownMesh(plc, options) { cells.judge_all(); }

  void insert_and_tell(const Point& p, const Feature& feature = {3, none}) {
    const Index vertex = insert(p, feature);
    sizes.cells_made(zone, vertex);
    triangles.cells_made(zone);
    cells.cells_made(zone, vertex);
  }
  void insert_random(std::size_t count) {
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> unit(-0.2, 1.2);
    for (std::size_t k = 0; k < count; ++k) insert_and_tell({unit(random), unit(random), unit(random)});
  }
  /// Returns the queued cells and faces that must still be destroyed, by their priority.
  std::array<std::set<Index>, WorkQueue::priority_count> due() {
    std::array<std::set<Index>, WorkQueue::priority_count> found;
    for (WorkQueue::Item item; queue.pop(item);) {
      const bool is_cell =
          item.priority == WorkQueue::skinny_cells || item.priority == WorkQueue::large_cells;
      if (is_cell ? cells.is_due(item) : triangles.is_due(item.entry))
        found[item.priority].insert(item.entry.id);
    }
    return found;
  }

  WorkQueue queue{100};
  RandomOffsets offsets{0, collars};
  GradedSizes sizes{domain, mesh, surface};
  FacingSheets facing_sheets{domain, mesh, nodes, collars, surface};
  TriangleQuality triangles{domain, mesh, nodes, surface, sizes, facing_sheets, offsets, queue};
  CellQuality cells{domain, mesh, collar_cells, surface, sizes, facing_sheets, offsets, queue};
};

double radius_edge(const RefinedMesh& mesh, Index cell) {
  double shortest = INFINITY;
  for (const Index a : mesh.corners(cell))
    for (const Index b : mesh.corners(cell))
      if (a != b) shortest = std::min(shortest, squared_distance(mesh.point(a), mesh.point(b)));
  return std::sqrt(mesh.squared_radius(cell) / shortest);
}

TEST(RefineCellQuality, QueuesSkinnyCellsAndLargeOnesInside) {
  const Plc plc = unit_box();
  Judges judges(plc, with_size(0.3));
  judges.insert_random(150);
  const auto due = judges.due();
  std::size_t skinny = 0, large = 0;
  for (Index cell = 0; cell < judges.mesh.cell_capacity(); ++cell) {
    if (!judges.mesh.alive(cell)) continue;
    const Index region = judges.surface.region(cell);
    const double bound = region == 0 ? std::max(judges.domain.options.exterior_radius_edge,
                                                judges.domain.options.bounds.radius_edge)
                                     : judges.domain.options.bounds.radius_edge;
    if (radius_edge(judges.mesh, cell) > bound) {
      EXPECT_EQ(due[WorkQueue::skinny_cells].contains(cell),
                judges.domain.in_box(judges.mesh.circumcentre(cell)));
      ++skinny;
    } else if (region != 0) {
      const double most = judges.sizes.asked().cell_radius(region, judges.mesh.circumcentre(cell), INFINITY);
      EXPECT_EQ(due[WorkQueue::large_cells].contains(cell), judges.mesh.squared_radius(cell) > most * most);
      large += due[WorkQueue::large_cells].contains(cell);
    } else {
      EXPECT_FALSE(due[WorkQueue::large_cells].contains(cell));
    }
  }
  EXPECT_GT(skinny, 0U);
  EXPECT_GT(large, 0U);
}

TEST(RefineCellQuality, WithAVertexRatioOlderCellsAreQueuedWhenAnEdgeBecomesShort) {
  const Plc plc = unit_box();
  MeshOptions options = with_size(10);
  options.vertex_ratio = 3;
  options.bounds.radius_edge = options.exterior_radius_edge = 100;
  Judges judges(plc, options);
  judges.insert_random(80);
  judges.due();
  const Point at = judges.mesh.point(40);
  judges.insert_and_tell(at + Vector{1e-3, 2e-3, 1e-3});
  const auto due = judges.due();
  std::vector<bool> made(judges.mesh.cell_capacity(), false);
  for (const Index cell : judges.zone.created) made[cell] = true;
  std::vector<Index> around;
  judges.mesh.incident_cells(40, around);
  for (const Index cell : around)
    if (judges.surface.region(cell) != 0 && !made[cell]) {
      EXPECT_TRUE(due[WorkQueue::large_cells].contains(cell));
    }
}

TEST(RefineCellQuality, ACandidateDestroysItsCell) {
  const Plc plc = unit_box();
  Judges judges(plc, with_size(0.3));
  judges.insert_random(60);
  const auto due = judges.due();
  for (const Index cell : due[WorkQueue::skinny_cells]) {
    const auto candidate = judges.cells.candidate(cell);
    if (!candidate) continue;
    EXPECT_EQ(candidate->start, cell);
    EXPECT_TRUE(judges.mesh.in_conflict(cell, candidate->point));
    EXPECT_EQ(candidate->feature.dimension, 3);
  }
}

TEST(RefineTriangleQuality, UnresolvedTrianglesAreQueuedUntilTheyAreGivenUp) {
  const Plc plc = unit_box();
  Judges judges(plc, with_size(0.3));
  judges.insert_random(60);  // none of these points is known to lie on a patch
  const auto due = judges.due();
  const auto faces = judges.surface.marked_faces();
  ASSERT_GT(faces.size(), 20U);
  for (const FaceId face : faces)
    EXPECT_TRUE(due[WorkQueue::unresolved_triangles].contains(face) ||
                due[WorkQueue::unresolved_triangles].contains(judges.mesh.opposite(face)));
  const WorkQueue::Entry entry{faces[0], judges.mesh.generation(cell_of(faces[0]))};
  EXPECT_TRUE(judges.triangles.is_due(entry));
  judges.triangles.give_up(faces[0]);
  EXPECT_FALSE(judges.triangles.is_due(entry));
  judges.triangles.split(faces[0]);
  EXPECT_TRUE(judges.due()[WorkQueue::unresolved_triangles].empty());
  judges.triangles.split(faces[1]);
  EXPECT_TRUE(judges.due()[WorkQueue::unresolved_triangles].contains(faces[1]));
}

TEST(RefineTriangleQuality, OnlyCellsYieldToTriangles) {
  const Plc plc = unit_box();
  Judges judges(plc, with_size(0.3));
  judges.insert_random(60);
  const FaceId face = judges.surface.marked_faces()[5];
  const RestrictedTriangle& t = judges.surface.triangle(face);
  judges.find_zone(t.x);
  Candidate candidate{t.x, 1, t.x, {3, none}, judges.zone.cells[0]};
  const FaceId deepest = judges.triangles.encroached(judges.zone, candidate);
  ASSERT_NE(deepest, no_face);
  const RestrictedTriangle& found = judges.surface.triangle(deepest);
  EXPECT_GE(found.squared_radius - squared_distance(found.x, t.x), t.squared_radius);
  candidate.feature = {2, 0};
  EXPECT_EQ(judges.triangles.encroached(judges.zone, candidate), no_face);
}

TEST(RefineTriangleQuality, InBlocksIsAskedWhereNothingIsFacedAndACellIsBeside) {
  const Plc plc = unit_box();
  Judges judges(plc, with_size(0.3));
  judges.insert_random(40);
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int k = 0; k < 20; ++k) judges.insert_and_tell({unit(random), unit(random), 0}, {2, 0});
  std::size_t asked = 0, faced = 0;
  for (const FaceId face : judges.surface.marked_faces()) {
    const Index patch = judges.surface.patch(face);
    const auto v = judges.mesh.face_vertices(face);
    const bool faces_any = std::any_of(v.begin(), v.end(), [&](Index vertex) {
      const Feature& f = judges.mesh.feature(vertex);
      return f.dimension == 2 && f.index != patch;
    });
    RandomOffsets own{7, judges.collars};
    const auto candidate = judges.triangles.candidate_beside(face, own);
    if (faces_any) {
      EXPECT_FALSE(candidate);
      ++faced;
    }
    if (!candidate) continue;
    ++asked;
    EXPECT_TRUE(candidate->start == cell_of(face) || candidate->start == cell_of(judges.mesh.opposite(face)));
    EXPECT_TRUE(judges.mesh.in_conflict(candidate->start, candidate->point));
    EXPECT_EQ(candidate->feature.dimension, 2);
    EXPECT_EQ(candidate->feature.index, patch);
  }
  EXPECT_GT(asked, 10U);
  EXPECT_GT(faced, 0U);
}

TEST(RefineTriangleQuality, InBlocksQueuesWhatTheLoopWould) {
  const Plc plc = unit_box();
  const auto insert = [](Judges& judges) {  // does not judge the new cells yet
    judges.insert_random(60);
    const FaceId face = judges.surface.marked_faces()[5];
    const Feature patch{2, judges.surface.patch(face)};
    const Index vertex = judges.insert(judges.surface.triangle(face).x, patch);
    judges.sizes.cells_made(judges.zone, vertex);
    judges.due();
  };
  const auto entries_of = [](WorkQueue& queue) {
    std::vector<std::array<Index, 3>> entries;
    for (WorkQueue::Item item; queue.pop(item);)
      entries.push_back({item.priority, item.entry.id, item.entry.stamp});
    return entries;
  };
  Judges in_block(plc, with_size(0.3)), in_loop(plc, with_size(0.3));
  insert(in_block);
  insert(in_loop);
  WorkQueue of_block{100};
  in_block.triangles.cells_made(in_block.zone, of_block);
  EXPECT_TRUE(entries_of(in_block.queue).empty());
  in_loop.triangles.cells_made(in_loop.zone);
  const auto expected = entries_of(in_loop.queue);
  EXPECT_GT(expected.size(), 3U);
  EXPECT_EQ(entries_of(of_block), expected);
}

TEST(RefineFacingSheets, CellsBetweenPairsAreSparedByTheRestOfTheirEdges) {
  const Plc plc = unit_box();
  Judges judges(plc, with_size(10));
  const Index a = judges.mesh.vertex_count();
  judges.insert_and_tell({0.5, 0.5, 0.5});
  judges.insert_and_tell({0.5, 0.5, 0.501});
  std::vector<Index> cells;
  judges.mesh.incident_cells(a, cells);
  const auto at_pair = std::find_if(cells.begin(), cells.end(), [&](Index cell) {
    const auto& v = judges.mesh.corners(cell);
    return std::count(v.begin(), v.end(), a) + std::count(v.begin(), v.end(), a + 1) == 2;
  });
  ASSERT_NE(at_pair, cells.end());
  EXPECT_FALSE(judges.facing_sheets.is_within(*at_pair, 10));
  judges.facing_sheets.note_pair(a + 1, a);
  EXPECT_TRUE(judges.facing_sheets.is_within(*at_pair, 10));
  EXPECT_FALSE(judges.facing_sheets.is_within(*at_pair, 1e-3));
}

TEST(RefineGradedSizes, SpreadUntilNoneGrowsFasterThanTheGradation) {
  const Plc plc = unit_box();
  MeshOptions options = with_size(1);
  options.gradation = 0.3;
  Judges judges(plc, options);
  judges.insert_random(100);
  judges.sizes.impose(std::vector<Index>{50, 70}, 0.01, 0);
  ASSERT_TRUE(judges.sizes.spread());
  std::vector<Index> adjacent;
  const auto size_at = [&](Index v) { return judges.sizes.graded(std::vector<Index>{v}, 0); };
  EXPECT_EQ(size_at(50), 0.01);
  for (Index v = 0; v < judges.mesh.vertex_count(); ++v) {
    judges.mesh.adjacent_vertices(v, adjacent);
    for (const Index u : adjacent)
      EXPECT_LE(size_at(u),
                (size_at(v) + 0.3 * distance(judges.mesh.point(u), judges.mesh.point(v))) * (1 + 1e-5));
  }
}

TEST(RefineGradedSizes, WithoutGradationNothingIsImposed) {
  const Plc plc = unit_box();
  Judges judges(plc, with_size(1));
  judges.insert_random(10);
  judges.sizes.impose(std::vector<Index>{8}, 0.01, 0);
  EXPECT_EQ(judges.sizes.graded(std::vector<Index>{8}, 1), INFINITY);
  EXPECT_FALSE(judges.sizes.spread());
}

TEST(RefineCollarCells, CellsAreInsideWhenABallHoldsTheirCircumcentre) {
  const PolygonSoup soup = testing::wedge(30, 1);
  const Plc plc = build_plc({&soup, 1});
  KnownMesh known(plc);
  CollarOptions options;
  options.size = [](const Feature&, const Point&) { return 0.2; };
  options.tolerance = SurfaceTolerance(0.01);
  known.collars = CollarSystem(plc, known.domain.points, find_creases(plc, 60), options);
  ASSERT_FALSE(known.collars.empty());
  for (Index v = 0; v < known.mesh.vertex_count(); ++v) known.collar_cells.note_near(v);
  for (const CollarBall& ball : known.collars.balls()) known.insert(ball.centre);
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> unit(-0.1, 1.1);
  for (int k = 0; k < 300; ++k) known.insert({unit(random), 0.4 * unit(random), unit(random)});
  std::size_t inside = 0, near = 0;
  const auto expect_all_right = [&] {
    for (Index cell = 0; cell < known.mesh.cell_capacity(); ++cell) {
      if (!known.mesh.alive(cell)) continue;
      const bool held = known.collars.ball_containing(known.mesh.circumcentre(cell)) != none;
      ASSERT_EQ(known.collar_cells.inside(cell), held);
      inside += held;
      for (const Index v : known.mesh.corners(cell)) EXPECT_TRUE(!held || known.collar_cells.near(v));
    }
  };
  const auto count_near = [&] {
    std::size_t count = 0;
    for (Index v = 0; v < known.mesh.vertex_count(); ++v) count += known.collar_cells.near(v);
    return count;
  };
  expect_all_right();
  EXPECT_GT(inside, 0U);
  near = count_near();
  known.collar_cells.forget_far_vertices();
  expect_all_right();
  EXPECT_LT(count_near(), near);
}

TEST(RefineCollarCells, ACellIsTakenInAsLongAsItLives) {
  const Plc plc = unit_box();
  KnownMesh known(plc);
  known.insert({0.5, 0.5, 0.5});
  known.find_zone({0.4, 0.45, 0.5});
  const Index cell = known.zone.cells[0];
  EXPECT_EQ(known.collar_cells.taken_in_by(cell), none);
  known.collar_cells.take_in(cell, 7);
  EXPECT_TRUE(known.collar_cells.inside(cell));
  EXPECT_EQ(known.collar_cells.taken_in_by(cell), 7U);
  known.insert({0.4, 0.45, 0.5});
  EXPECT_EQ(known.collar_cells.taken_in_by(cell), none);
}

}  // namespace
}  // namespace collarmesh::refinement_judges_test
