// Narrow places between features much nearer to each other than elements are large: their cost does not grow
// as they get narrower, no volume is lost, and every guarantee holds.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "collarmesh/pipeline.h"
#include "support/meshing.h"
#include "support/shapes.h"

namespace collarmesh::narrow_places_test {
namespace {

using namespace collarmesh::testing;

SoupPipelineResult run(const std::vector<PolygonSoup>& soups, unsigned order, bool coarsen = true) {
  PipelineOptions options;
  options.mesh = with_size(0.4, 200'000);
  options.coarsen = coarsen;
  options.order = order;
  return run_pipeline(soups, options);
}

// Three boxes on top of each other, the middle one with this thickness.
std::vector<PolygonSoup> layers(double thickness) {
  return {box({0, 0, 0}, {2, 2, 1}), box({0, 0, 1}, {2, 2, 1 + thickness}),
          box({0, 0, 1 + thickness}, {2, 2, 2})};
}
// A step of this height across a block.
std::vector<PolygonSoup> step(double height) {
  const std::vector<Point> outline{{0, 0, 0}, {2, 0, 0},          {2, 1, 0},
                                   {1, 1, 0}, {1, 1 - height, 0}, {0, 1 - height, 0}};
  return {extrusion(outline, 2)};
}
// A block with a fin of this width on it.
std::vector<PolygonSoup> fin(double width) {
  const std::vector<Point> outline{{0, 0, 0},         {2, 0, 0}, {2, 1, 0}, {1 + width, 1, 0},
                                   {1 + width, 2, 0}, {1, 2, 0}, {1, 1, 0}, {0, 1, 0}};
  return {extrusion(outline, 2)};
}

struct Family {
  std::string name;
  std::vector<PolygonSoup> (*member)(double);
  double (*volume)(double);  // volume of the region under test: the last region, except in the family of
                             // layers
  std::size_t region;
};

std::vector<Family> families() {
  return {{"layers", layers, [](double t) { return 4 * t; }, 2},
          {"step", step, [](double t) { return 2 * (2 - t); }, 1},
          {"fin", fin, [](double t) { return 4 + 2 * t; }, 1}};
}

// (Around the rim of a fin's large sides, subsegments still become as short as the fin is wide.)
TEST(NarrowPlaces, TakeNoMoreVerticesAsTheyGetNarrower) {
  for (const Family& family : {families()[0], families()[1]}) {
    SCOPED_TRACE(family.name);
    std::size_t first = 0;
    for (const double width : {1e-2, 1e-3, 1e-4, 1e-5}) {
      SCOPED_TRACE(width);
      MeshOptions options = with_size(0.4, 20'000);
      options.narrow_cells = NarrowCells::left;
      const Meshed made = mesh_of(family.member(width), options, 30);
      EXPECT_EQ(made.result.status, MeshStatus::complete);
      EXPECT_NEAR(made.report.region_volumes[family.region], family.volume(width), 1e-9);
      const std::size_t inserted = made.result.statistics.vertices_inserted;
      if (first == 0) first = inserted;
      EXPECT_LT(inserted, first + first / 2);
    }
  }
}

// Where bounded ratios are cheap, angles are as large as elsewhere.
TEST(NarrowPlaces, AreRefinedWhereThatIsCheap) {
  for (const double width : {5e-2, 2e-3}) {
    SCOPED_TRACE(width);
    // The pad is as thin as the layer, but covers only a small part of the block.
    const std::vector<PolygonSoup> pad{box({0, 0, 0}, {2, 2, 1}),
                                       box({1, 1, 1}, {1 + 4 * width, 1 + 4 * width, 1 + width})};
    const SoupPipelineResult small = run(pad, 1), large = run(layers(width), 1);
    EXPECT_EQ(small.missed(), "");
    EXPECT_FALSE(small.result.has_narrow_cells);
    EXPECT_EQ(small.check.forced_tets, 0U);
    EXPECT_EQ(large.missed(), "");
    EXPECT_EQ(large.result.has_narrow_cells, width < 1e-2);
    EXPECT_EQ(large.check.forced_tets > 0, width < 1e-2);
  }
}

// If the budget suffices only for the mesh with narrow cells, that mesh is made.
TEST(NarrowPlaces, LeaveTheBudgetToTheRest) {
  const Plc plc = build_plc(layers(2e-2));
  MeshOptions options = with_size(0.4, 0);
  options.narrow_cells = NarrowCells::left;
  const std::size_t left = generate(plc, options).statistics.vertices_inserted;
  options.narrow_cells = NarrowCells::bounded;
  ASSERT_GT(generate(plc, options).statistics.vertices_inserted, left + left / 4);
  options.narrow_cells = NarrowCells::bounded_if_cheap;
  options.max_vertices = left + left / 8;
  const MeshResult made = generate(plc, options);
  EXPECT_EQ(made.status, MeshStatus::complete) << made.message;
  EXPECT_TRUE(made.has_narrow_cells);
  EXPECT_EQ(made.statistics.vertices_inserted, left);
}

// Places that are not narrow are meshed as if there could be no narrow ones.
TEST(NarrowPlaces, ElsewhereChangeNothing) {
  const std::vector<PolygonSoup> block{box({0, 0, 0}, {2, 2, 1})};
  const Plc plc = build_plc(block);
  const auto made = [&](NarrowCells narrow) {
    MeshOptions options = with_size(0.4, 20'000);
    options.narrow_cells = narrow;
    return generate(plc, options).mesh;
  };
  const TetMesh bounded = made(NarrowCells::bounded);
  for (const NarrowCells narrow : {NarrowCells::left, NarrowCells::bounded_if_cheap})
    EXPECT_EQ(made(narrow).tets, bounded.tets);
}

class NarrowPlacesOfOrder : public ::testing::TestWithParam<int> {};

TEST_P(NarrowPlacesOfOrder, KeepEveryGuarantee) {
  for (const Family& family : families())
    for (const double width : {1e-1, 1e-2, 2e-3, 1e-4}) {
      if (family.name == "fin" && width < 1e-2) continue;  // its rim still takes many vertices
      SCOPED_TRACE(family.name);
      SCOPED_TRACE(width);
      const SoupPipelineResult made = run(family.member(width), static_cast<unsigned>(GetParam()));
      EXPECT_EQ(made.missed(), "");
      EXPECT_NEAR(made.check.region_volumes[family.region], family.volume(width), 1e-9);
    }
}

INSTANTIATE_TEST_SUITE_P(Orders, NarrowPlacesOfOrder, ::testing::Values(1, 2));

// Without coarsening the ratio is bounded everywhere, and the cost of a narrow place depends on its width.
TEST(NarrowPlaces, KeepTheRatioWithoutCoarsening) {
  for (const Family& family : families()) {
    SCOPED_TRACE(family.name);
    const SoupPipelineResult made = run(family.member(0.1), 1, false);
    EXPECT_EQ(made.missed(), "");
    EXPECT_LE(made.check.max_radius_edge, 2);
    EXPECT_EQ(made.check.thin_tets, 0U);
  }
}

}  // namespace
}  // namespace collarmesh::narrow_places_test
