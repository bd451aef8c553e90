// The number of vertices that a refinement may take before other repairs are tried.
#include "pipeline/vertex_bound.h"

#include <gtest/gtest.h>

#include "pipeline/vertex_budget.h"
#include "support/shapes.h"

namespace collarmesh::vertex_bound_test {
namespace {

using testing::box;

std::size_t bound(const Plc& plc, const MeshOptions& mesh) {
  PipelineOptions options;
  options.mesh = mesh;
  return most_vertices_expected(plc, options);
}

Plc boxes_apart(double gap) { return build_plc(std::vector{box(), box({0, 0, 1 + gap}, {1, 1, 2})}); }

TEST(VertexBound, DoesNotGrowWithNearFeatures) {
  const std::size_t far = bound(boxes_apart(0.1), {.size = 0.1}),
                    near = bound(boxes_apart(1e-6), {.size = 0.1});
  EXPECT_NEAR(static_cast<double>(near), static_cast<double>(far), 0.1 * static_cast<double>(far));
}

TEST(VertexBound, IsFarAboveTheVerticesOfPlainShapes) {
  const Plc plc = boxes_apart(0.5);
  for (const double size : {0.5, 0.2, 0.1}) {
    const MeshResult made = generate(plc, {.size = size});
    ASSERT_EQ(made.status, MeshStatus::complete);
    EXPECT_GE(bound(plc, {.size = size}), 4 * made.statistics.vertices_inserted) << size;
  }
}

TEST(VertexBound, GrowsWithWhatIsAskedFor) {
  const Plc plc = boxes_apart(0.5);
  const MeshOptions plain{.size = 0.2};
  const std::size_t usual = bound(plc, plain);
  const auto with = [&](const auto& change) {
    MeshOptions options = plain;
    change(options);
    return bound(plc, options);
  };
  EXPECT_GT(with([](MeshOptions& o) { o.size = 0.05; }), 2 * usual);
  EXPECT_GT(with([](MeshOptions& o) { o.region_size[1] = 0.02; }), 2 * usual);
  EXPECT_GT(with([](MeshOptions& o) { o.patch_size[1] = 0.005; }), 2 * usual);
  EXPECT_GT(with([](MeshOptions& o) { o.size_field = [](const Point&) { return 0.02; }; }), 2 * usual);
  EXPECT_GT(with([](MeshOptions& o) { o.bounds.radius_edge = 1.2; }), 2 * usual);
  EXPECT_GT(with([](MeshOptions& o) { o.bounds.distance = 1e-3; }), 2 * usual);
  EXPECT_GT(with([](MeshOptions& o) { o.vertex_ratio = 4; }), 2 * usual);
}

// A rod of radius 0.005 took 674,265 vertices until every guarantee held.
TEST(VertexBound, RodsFarThinnerThanTheSizeMayTakeWhatTheirChordsAskFor) {
  const auto on_rods = [](const std::vector<PolygonSoup>& soups) {
    return most_vertices_on_rods(build_plc(soups), {.size = 1});
  };
  const std::size_t thin = on_rods({testing::cylinder(0.005, 20, 24)});
  EXPECT_GT(thin, 680'000U);
  EXPECT_LE(thin, 1'000'000U);
  EXPECT_LT(on_rods({testing::cylinder(0.5, 20, 24)}), 20'000U);
  EXPECT_LT(on_rods({testing::cylinder(5, 10, 96)}), 20'000U);
  EXPECT_EQ(on_rods({box()}), 0U);
  EXPECT_EQ(on_rods({testing::icosphere(5, 12), testing::icosphere(4.99, 12)}), 0U)
      << "walls thinner than chords";
}

TEST(VertexBound, TheSmallestSizeIsThatOfAnyFeature) {
  EXPECT_EQ(smallest_size({}, 20), 1);
  EXPECT_EQ(smallest_size({.size = 0.5}, 20), 0.5);
  EXPECT_EQ(smallest_size({.region_size = {{1, 0.3}}, .patch_size = {{4, 0.2}}}, 20), 0.2);
}

TEST(VertexBudget, IsTightAfterAnExplosionWhileThereAreOtherWays) {
  const Plc plc = boxes_apart(0.5);
  PipelineOptions given;
  given.mesh.size = 0.1;
  pipeline::VertexBudget budget(given);
  const auto found = [&] {
    budget.find(plc, given);
    return budget.most();
  };
  budget.bound(pipeline::Ways::others);
  const std::size_t usual = found();
  EXPECT_EQ(usual, bound(plc, given.mesh));
  budget.tighten();
  EXPECT_EQ(found(), usual / 4);
  budget.bound(pipeline::Ways::constrained);
  EXPECT_EQ(found(), std::max<std::size_t>(usual, 100'000));
  budget.compare_with(usual);
  EXPECT_EQ(found(), std::max<std::size_t>(usual, 100'000));
  budget.compare_with(1);
  EXPECT_EQ(found(), 100'000U);
  budget.bound(pipeline::Ways::none);
  EXPECT_GE(found(), std::max<std::size_t>(2 * usual, 300'000));
}

}  // namespace
}  // namespace collarmesh::vertex_bound_test
