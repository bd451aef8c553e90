// One call from facets to a certified mesh, and ways to stop it.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <functional>
#include <numbers>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "collarmesh/error.h"
#include "collarmesh/pipeline.h"
#include "support/acute_shapes.h"
#include "support/expected_counts.h"
#include "support/shapes.h"

namespace collarmesh::pipeline_test {
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
  EXPECT_TRUE(check(made.result.mesh, made.plc, {}).passed());
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

/// A source of boxes that claim to have been repaired. In all but the right one, a patch changes its tag
/// after meshing, so that the certificate finds a fault.
class Boxes : public ComplexSource {
 public:
  RepairedPlc build(const RepairOptions& repair, const Execution& execution) override {
    built.push_back(repair);
    while (built.size() == waits_in && !execution.cancelled()) std::this_thread::yield();
    if (throws_after_first && built.size() > 1) throw PlcError("no complex", {});
    PolygonSoup soup = shape();  // moved a little each time, as repairs that change nothing are not meshed
    for (Point& p : soup.points) p.x += 1e-9 * static_cast<double>(built.size());
    RepairedPlc made{build_plc({&soup, 1}), {}, {}};
    made.report.repaired = true;
    made.report.wrapped = repair.wrap_at_once;
    made.report.tolerance = repair.tolerance;
    return made;
  }
  void adapt(const Plc& plc, PipelineOptions&) override {
    ++adapted;
    if (refuses_after_first && adapted > 1) throw OptionError("no such tag");
    at_hand = const_cast<Plc*>(&plc);
  }
  SoupPipelineResult run(const PipelineOptions& options, const Execution& execution = {}) {
    Execution spoiling = execution;
    spoiling.progress = [&](const ProgressReport& report) {
      if (report.begins && report.phase == "check" && built.size() != right) ++at_hand->patches[0].tag;
      return !execution.progress || execution.progress(report);
    };
    return run_pipeline(*this, options, spoiling);
  }

  std::size_t right = 0;     // number of the build that is right, from 1; 0: none
  std::size_t waits_in = 0;  // number of the build that goes on until it is cancelled
  bool throws_after_first = false, refuses_after_first = false;
  std::function<PolygonSoup()> shape = [] { return box(); };
  std::vector<RepairOptions> built;
  unsigned adapted = 0;

 private:
  Plc* at_hand = nullptr;
};

bool tells(const PipelineResult& result, const std::string& what) {
  return std::any_of(result.check.notes.begin(), result.check.notes.end(),
                     [&](const std::string& note) { return note.find(what) != std::string::npos; });
}

TEST(Pipeline, RepairsFurtherWhereAGuaranteeIsMissed) {
  Boxes boxes;
  boxes.right = 2;
  const SoupPipelineResult made = boxes.run(with_size(0.5));
  EXPECT_TRUE(made.guarantees_hold());
  ASSERT_EQ(boxes.built.size(), 2U);
  EXPECT_DOUBLE_EQ(made.repair.tolerance, 3 * RepairOptions{}.tolerance);
  EXPECT_TRUE(tells(made, "repaired with a tolerance of 3e-05"));
}

// Angles in collars do not get smaller by any change that repair makes.
TEST(Pipeline, DoesNotRepairForTheSakeOfCollars) {
  Boxes wedges;
  wedges.shape = [] { return testing::acute::wedge(37).soups[0]; };
  wedges.right = 1;
  PipelineOptions options = with_size(0.3);
  options.mesh.bounds.collar_angle = 100;
  options.repair.mode = RepairMode::wrap;
  const SoupPipelineResult made = wedges.run(options);
  EXPECT_FALSE(made.guarantees_hold());
  for (const Finding& finding : made.check.findings)
    EXPECT_NE(finding.message.find("of a collar"), std::string::npos) << finding.message;
  EXPECT_EQ(wedges.built.size(), 1U);
}

// In this case there is no mesh, and no certificate.
TEST(Pipeline, RefusesWhatNoCollarFitsInto) {
  PipelineOptions options = with_size(0.5);
  options.complex.weld = 0;
  options.repair.mode = RepairMode::off;
  const testing::acute::Shape shape = testing::acute::pairs_in_a_box(4, 1e-12);
  options.start = Start::refinement;
  EXPECT_THROW(run(shape.soups[0], options), PlcError);
  // Constrained tetrahedra need no collars. Tets around the facets miss the bounds by far, and the result
  // says so.
  options.start = Start::automatic;
  const SoupPipelineResult made = run(shape.soups[0], options);
  EXPECT_FALSE(made.guarantees_hold());
  double volume = 0;
  for (const auto& [a, b, c, d] : made.result.mesh.tets) {
    const auto& p = made.result.mesh.points;
    volume += six_volume(p[a], p[b], p[c], p[d]) / 6;
  }
  EXPECT_NEAR(volume, shape.volume, 1e-9);
}

TEST(Pipeline, WrapsLast) {
  Boxes boxes;
  boxes.right = 5;
  PipelineOptions options = with_size(0.5);
  options.repair.mode = RepairMode::wrap;
  const SoupPipelineResult made = boxes.run(options);
  EXPECT_TRUE(made.guarantees_hold());
  EXPECT_TRUE(made.repair.wrapped);
  ASSERT_EQ(boxes.built.size(), 5U);
  for (std::size_t b = 1; b < 4; ++b) {
    EXPECT_FALSE(boxes.built[b].wrap_at_once);
    EXPECT_GT(boxes.built[b].tolerance, boxes.built[b - 1].tolerance);
  }
  EXPECT_TRUE(tells(made, "wrapped, because without wrapping: "));
}

TEST(Pipeline, TheFirstMeshStaysWhereNoOtherIsBetter) {
  const auto expect_first = [](const SoupPipelineResult& made) {
    EXPECT_EQ(made.result.status, MeshStatus::complete);
    EXPECT_FALSE(made.guarantees_hold());
    EXPECT_FALSE(made.result.mesh.tets.empty());
    EXPECT_DOUBLE_EQ(made.repair.tolerance, RepairOptions{}.tolerance);
    EXPECT_FALSE(tells(made, "seed"));
  };
  Boxes all_wrong;
  expect_first(all_wrong.run(with_size(0.5)));
  EXPECT_EQ(all_wrong.built.size(), 5U) << "the first one again, for another seed";
  EXPECT_EQ(all_wrong.adapted, 5U);
  Boxes refused;
  refused.refuses_after_first = true;
  expect_first(refused.run(with_size(0.5)));
  Boxes thrown;
  thrown.throws_after_first = true;
  expect_first(thrown.run(with_size(0.5)));
  Boxes many;
  PipelineOptions options = with_size(0.5);
  options.seeds = 5;
  expect_first(many.run(options));
  EXPECT_EQ(many.adapted, 8U);
}

// The first further repair takes all the time that it gets.
TEST(Pipeline, TheFirstMeshStaysWhereARepairTakesTooLong) {
  Boxes boxes;
  PipelineOptions options = with_size(0.5);
  options.mesh.time_limit = 5;
  boxes.waits_in = 2;
  const SoupPipelineResult made = boxes.run(options);
  EXPECT_EQ(made.result.status, MeshStatus::complete) << made.result.message;
  EXPECT_FALSE(made.result.mesh.tets.empty());
  EXPECT_FALSE(made.guarantees_hold());
  EXPECT_DOUBLE_EQ(boxes.built.back().tolerance, RepairOptions{}.tolerance);
}

TEST(Pipeline, IsCancelledBetweenRepairs) {
  Boxes boxes;
  PipelineOptions options = with_size(0.5);
  options.repair.mode = RepairMode::wrap;
  Execution execution;
  std::size_t complexes = 0;
  execution.progress = [&](const ProgressReport& report) {
    return !(report.begins && report.phase == "complex" && ++complexes == 2);
  };
  const SoupPipelineResult made = boxes.run(options, execution);
  EXPECT_EQ(made.result.status, MeshStatus::cancelled);
  EXPECT_TRUE(made.result.mesh.tets.empty());
  EXPECT_EQ(boxes.built.size(), 1U);
}

TEST(Pipeline, ATightBudgetIsNoReasonToWrap) {
  Boxes boxes;
  boxes.right = 1;
  PipelineOptions options = with_size(0.05);
  options.repair.mode = RepairMode::wrap;
  options.mesh.max_vertices = 200;
  EXPECT_EQ(boxes.run(options).result.status, MeshStatus::budget_hit);
  EXPECT_EQ(boxes.built.size(), 1U);
}

// A box with a slit that opens at this angle: a slab with this angle lies on the box, turned by it.
PolygonSoup slit_box(double degrees) {
  const double a = degrees * std::numbers::pi / 180;
  PolygonSoup soup = box();
  for (Point& p : soup.points) p = {10 * p.x, 10 * p.y, 5 * p.z};
  PolygonSoup slab = box();
  for (Point& p : slab.points) {
    const double x = 5 * p.x - 2.5, y = 2 + 5 * p.y, z = p.z;
    p = {5 + x * std::cos(a) - z * std::sin(a), y, 5 + x * std::sin(a) + z * std::cos(a)};
  }
  return testing::joined(soup, slab);
}

TEST(Pipeline, TakesTheInputAgainWhereTheRefinementWouldExplode) {
  const SoupPipelineResult made = run(slit_box(0.007), {});
  ASSERT_TRUE(made.guarantees_hold()) << made.result.message;
  EXPECT_TRUE(tells(made, "because with 1e-05, features meet at 0.007 degrees"));
  EXPECT_LE(made.repair.largest_distance, made.repair.tolerance);
  EXPECT_GT(made.repair.largest_distance_of_input, 0);
  double volume = 0;
  for (Index r = 1; r < made.plc.regions.size(); ++r) volume += made.plc.regions[r].volume;
  EXPECT_NEAR(volume, 525, 0.01);
  testing::expect_count("pipeline/slit taken again", made.result.statistics.vertices_inserted);
}

// A box of 10 x 10 x 10 with a slit from one side to its middle that opens to 1e-7.
PolygonSoup box_with_a_slit() {
  constexpr std::array<std::array<double, 2>, 7> profile{
      {{0, 0}, {10, 0}, {10, 4}, {5, 4}, {10, 4 + 1e-7}, {10, 10}, {0, 10}}};
  constexpr Index n = profile.size();
  PolygonSoup soup;
  for (const double y : {0., 10.})
    for (const auto& [x, z] : profile) soup.points.push_back({x, y, z});
  std::vector<Index> front, back;
  for (Index i = 0; i < n; ++i) {
    const Index next = (i + 1) % n;
    front.push_back(i);
    back.push_back(2 * n - 1 - i);
    soup.add_facet({{i, i + n, next + n, next}});
  }
  soup.add_facet(front);
  soup.add_facet(back);
  return soup;
}

// Expects a message with the place of the explosion, the features near it, and a remedy.
void expect_bounded(const PipelineResult& made) {
  EXPECT_EQ(made.result.status, MeshStatus::budget_hit);
  EXPECT_TRUE(made.result.mesh.tets.empty());
  EXPECT_NEAR(made.result.where.z, 4, 1);
  EXPECT_GT(made.result.where.x, 4);
  for (const char* part : {"far more than the sizes ask for", "around (", " of patches ", "max-vertices"})
    EXPECT_NE(made.result.message.find(part), std::string::npos) << made.result.message;
}

TEST(Pipeline, EndsWhereTheRefinementExplodesAndNoOtherRepairMayBeTried) {
  PipelineOptions options = with_size(10);
  options.repair.mode = RepairMode::off;
  options.start = Start::refinement;
  expect_bounded(run(box_with_a_slit(), options));
}

// Constrained tetrahedra take no more tets where sheets are near each other.
TEST(Pipeline, BeginsWithConstrainedTetrahedraWhereTheRefinementExplodes) {
  PipelineOptions options = with_size(10);
  options.repair.mode = RepairMode::off;
  const SoupPipelineResult made = run(box_with_a_slit(), options);
  EXPECT_FALSE(made.result.mesh.tets.empty());
  testing::expect_count("pipeline/slit begun constrained", made.result.mesh.tets.size());
  for (const Finding& finding : made.check.findings)
    EXPECT_TRUE(finding.guarantee == "thin_angles" || finding.guarantee == "collar_dihedral")
        << finding.message;
  EXPECT_TRUE(std::any_of(made.check.notes.begin(), made.check.notes.end(), [](const std::string& note) {
    return note.starts_with("begun with constrained tetrahedra");
  }));
}

// A coarser repair would lose the material of a thin plate elsewhere.
TEST(Pipeline, EndsWhereTheRefinementExplodesAndNoOtherRepairHelps) {
  std::array<PolygonSoup, 2> soups{box_with_a_slit(), box()};
  for (Point& p : soups[1].points) p = {p.x, p.y, -4 + 1e-3 * p.z};
  soups[0].region_tag = 1;
  soups[1].region_tag = 2;
  PipelineOptions options = with_size(10);
  options.repair.tolerance = 1e-9;
  options.start = Start::refinement;
  expect_bounded(run_pipeline(soups, options));
}

TEST(Pipeline, MovesOntoExactGeometry) {
  const PolygonSoup sphere = icosphere(1, 16);
  const std::span<const PolygonSoup> soups(&sphere, 1);
  const Plc plc = build_plc(soups);
  PipelineOptions options = with_size(0.3);
  options.mesh.bounds.distance = 0.05;
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
}  // namespace collarmesh::pipeline_test
