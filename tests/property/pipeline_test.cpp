// One call from facets to a certified mesh, and how it is stopped.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <set>
#include <string>
#include <vector>

#include "collarmesh/error.h"
#include "collarmesh/pipeline.h"
#include "support/shapes.h"

namespace collarmesh {
namespace {

using testing::box;
using testing::icosphere;

PipelineOptions with_size(double size) {
  PipelineOptions options;
  options.mesh.size = size;
  return options;
}

SoupPipelineResult run(const PolygonSoup& soup, const PipelineOptions& options,
                       const Execution& execution = {}) {
  return run_pipeline({&soup, 1}, options, execution);
}

std::size_t slivers(const TetMesh& mesh, double angle) {
  std::size_t count = 0;
  for (const auto& [a, b, c, d] : mesh.tets)
    if (measure(mesh.points[a], mesh.points[b], mesh.points[c], mesh.points[d]).min_dihedral < angle) ++count;
  return count;
}

TEST(Pipeline, MeshesWithoutSliversAndCertifies) {
  PipelineOptions options = with_size(0.2);
  options.order = 2;
  const SoupPipelineResult made = run(icosphere(1, 6), options);
  EXPECT_TRUE(made.guarantees_hold());
  EXPECT_EQ(slivers(made.result.mesh, 8), 0U);
  EXPECT_EQ(made.result.mesh.order(), 2);
  EXPECT_TRUE(
      check(made.result.mesh, made.plc, {.distance = distance_of(options, made.plc.bounds.diagonal())})
          .passed());
  options.coarsen = false;
  options.improve = 0;
  options.order = 1;
  EXPECT_GT(slivers(run(icosphere(1, 6), options).result.mesh, 8), 0U) << "the test sees no slivers";
}

TEST(Pipeline, RepairsAndTellsIt) {
  PolygonSoup open;
  const PolygonSoup whole = box();
  open.points = whole.points;
  for (Index f = 1; f < whole.facet_count(); ++f) open.add_facet(whole.polygon(whole.facet_polygons(f)[0]));
  const SoupPipelineResult made = run(open, with_size(0.5));
  EXPECT_TRUE(made.repair.repaired);
  EXPECT_TRUE(made.guarantees_hold());
  ASSERT_FALSE(made.check.notes.empty());
  PipelineOptions strict = with_size(0.5);
  strict.repair.mode = RepairMode::off;
  EXPECT_THROW(run(open, strict), PlcError);
}

TEST(Pipeline, WrapsOnlyWhatTakesFarMoreVerticesThanItsSizesAskFor) {
  const PolygonSoup soup = box();
  const Plc plc = build_plc({&soup, 1});
  PipelineOptions options = with_size(0.1);
  RepairOptions coarser, wrap;
  wrap.mode = RepairMode::wrap;
  wrap.wrap_at_once = true;
  EXPECT_EQ(before_next_repair(options, coarser, plc).mesh.max_vertices, 0U);
  EXPECT_EQ(before_next_repair(options, coarser, plc).seeds, 1U);
  const std::size_t budget = before_next_repair(options, wrap, plc).mesh.max_vertices;
  EXPECT_GT(budget, 100 * run(soup, options).result.statistics.vertices_inserted);
  EXPECT_LT(budget, 1'000'000U);
  options.mesh.max_vertices = 1000;
  EXPECT_EQ(before_next_repair(options, wrap, plc).mesh.max_vertices, 1000U);
  options.mesh.max_vertices = 0;
  options.mesh.patch_size[1] = 1e-4;  // which may well need more
  EXPECT_EQ(before_next_repair(options, wrap, plc).mesh.max_vertices, 0U);
}

TEST(Pipeline, MovesOntoExactGeometry) {
  const PolygonSoup sphere = icosphere(1, 16);
  const std::span<const PolygonSoup> soups(&sphere, 1);
  const Plc plc = build_plc(soups);
  PipelineOptions options = with_size(0.3);
  options.mesh.distance = 0.05;
  options.exact = [](unsigned, Index, const Point& p) -> std::optional<Point> {
    return p / norm(p - Point{});
  };
  const PipelineResult made = run_pipeline(plc, options);
  ASSERT_TRUE(made.projection);
  EXPECT_TRUE(made.projection->exceptions.empty());
  EXPECT_TRUE(made.guarantees_hold());
  for (const auto& face : made.result.mesh.faces)
    for (const Index v : face) EXPECT_NEAR(norm(made.result.mesh.points[v] - Point{}), 1, 1e-9);
}

TEST(Pipeline, TellsEveryStageAndOneFraction) {
  std::vector<std::string> stages;
  double before = 0;
  Execution execution;
  execution.progress = [&](const ProgressReport& report) {
    if (report.begins) stages.emplace_back(report.phase);
    EXPECT_GE(report.fraction, before);
    before = report.fraction;
    return true;
  };
  PipelineOptions options = with_size(0.3);
  options.order = 2;
  run(box(), options, execution);
  EXPECT_EQ(stages,
            (std::vector<std::string>{"complex", "refine", "coarsen", "improve", "second order", "check"}));
  EXPECT_LE(before, 1);
}

TEST(Pipeline, IsCancelledInEveryStage) {
  for (const std::string stage : {"complex", "refine", "coarsen", "improve", "second order", "check"}) {
    Execution execution;
    execution.progress = [&](const ProgressReport& report) { return report.phase != stage; };
    PipelineOptions options = with_size(0.3);
    options.order = 2;
    const SoupPipelineResult made = run(box(), options, execution);
    EXPECT_EQ(made.result.status, MeshStatus::cancelled) << stage;
    EXPECT_TRUE(made.result.mesh.tets.empty()) << stage;
    EXPECT_FALSE(made.guarantees_hold()) << stage;
  }
  std::atomic<bool> flag{true};
  Execution execution;
  execution.cancel = &flag;
  EXPECT_EQ(run(box(), with_size(0.3), execution).result.status, MeshStatus::cancelled);
}

TEST(Pipeline, KeepsOneTimeLimitForAllStages) {
  PipelineOptions options = with_size(0.002);
  options.mesh.time_limit = 0.3;
  const SoupPipelineResult made = run(box(), options);
  EXPECT_EQ(made.result.status, MeshStatus::budget_hit);
  EXPECT_NE(made.result.message.find("time limit of 0.3 s"), std::string::npos) << made.result.message;
}

TEST(Pipeline, RefusesSizesOfTagsThatAreNotThere) {
  PipelineOptions options = with_size(0.5);
  options.mesh.patch_size = {{77, 0.1}};
  EXPECT_THROW(run(box(), options), OptionError);
  options = with_size(0.5);
  options.order = 3;
  EXPECT_THROW(run(box(), options), OptionError);
}

}  // namespace
}  // namespace collarmesh
