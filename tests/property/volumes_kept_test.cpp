// A mesh whose regions lost much of their volumes is made again, nearer to their surfaces. Thin rods are made
// of rings, unless more than one size is asked for.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <string>
#include <thread>

#include "collarmesh/pipeline.h"
#include "collarmesh/plc_builder.h"
#include "common/run_control.h"
#include "support/expected_counts.h"
#include "support/meshing.h"
#include "support/shapes.h"

namespace collarmesh::volumes_kept_test {
namespace {

using namespace testing;

PipelineOptions asked(double size) {
  PipelineOptions options;
  options.mesh = with_size(size);
  options.mesh.threads = 1;
  return options;
}

bool has_note(const PipelineResult& made, const std::string& text) {
  return std::ranges::any_of(made.check.notes,
                             [&](const std::string& note) { return note.find(text) != std::string::npos; });
}

PolygonSoup shell() {
  constexpr double radius = 4, thickness = 0.2;
  return joined(uv_sphere(radius, 8, 16), inverted(uv_sphere(radius - thickness, 8, 16)));
}

TEST(VolumesKept, ShellsLoseLessThanWarningsTell) {
  const PolygonSoup soup = shell();
  const SoupPipelineResult made = run_pipeline({&soup, 1}, asked(1.5));
  EXPECT_EQ(made.missed(), "");
  EXPECT_TRUE(has_note(made, "nearer to smooth surfaces"));
  const double input = made.check.of_input.volumes.at(1);
  EXPECT_NEAR(made.check.of_mesh.volumes.at(1), input, 0.02 * input);
}

TEST(VolumesKept, AttemptsLeaveTimeForTheMeshAtHand) {
  PipelineOptions options = asked(1);
  options.mesh.time_limit = 60;
  PipelineResult made;
  const Execution execution;
  RunControl control(options, execution, made);
  bool ended = false;
  control.attempt(1e-3, [&] {
    while (!control.execution().cancelled()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    EXPECT_TRUE(control.out_of_time());
    EXPECT_THROW(control.stop_if_asked(), Ended);
    EXPECT_EQ(made.result.status, MeshStatus::budget_hit);
    ended = true;
  });
  EXPECT_TRUE(ended);
  EXPECT_FALSE(control.out_of_time());
  EXPECT_FALSE(control.execution().cancelled());
  EXPECT_NO_THROW(control.stop_if_asked());
}

struct Gate {
  const char* name;
  std::function<void(Plc&, PipelineOptions&)> ask;
};

class RodsAskedFor : public ::testing::TestWithParam<Gate> {};

TEST_P(RodsAskedFor, AreRefinedUnlessThereIsNothingButASize) {
  Plc plc = build_plc(std::vector{cylinder(0.3, 3, 24)});
  PipelineOptions options = asked(1);
  const auto& [name, ask] = GetParam();
  ask(plc, options);
  bool refined = false;
  Execution execution;
  execution.progress = [&](const ProgressReport& report) {
    refined |= report.phase == "refine";
    return !refined;
  };
  const PipelineResult made = run_pipeline(plc, options, execution);
  EXPECT_EQ(refined, std::string(name) != "Nothing");
  EXPECT_EQ(has_note(made, "rings"), !refined);
}

INSTANTIATE_TEST_SUITE_P(
    Options, RodsAskedFor,
    ::testing::Values(
        Gate{"Nothing", [](Plc&, PipelineOptions&) {}},
        Gate{"RegionSize", [](Plc& plc, PipelineOptions&) { plc.regions[1].size = 0.9; }},
        Gate{"Distance", [](Plc&, PipelineOptions& options) { options.mesh.bounds.distance = 0.05; }},
        Gate{"MaxVertices", [](Plc&, PipelineOptions& options) { options.mesh.max_vertices = 60; }},
        Gate{"MinDihedral", [](Plc&, PipelineOptions& options) { options.min_dihedral = 25; }},
        Gate{"RadiusEdge",
             [](Plc&, PipelineOptions& options) { options.mesh.bounds.thin_in_narrow_places_only = true; }}),
    [](const auto& info) { return info.param.name; });

TEST(VolumesKept, RodsAreMadeOfRings) {
  for (const unsigned order : {1U, 2U}) {
    const PolygonSoup soup = cylinder(0.05, 5, 96);
    PipelineOptions options = asked(1);
    options.order = order;
    options.trace = true;
    const SoupPipelineResult made = run_pipeline({&soup, 1}, options);
    EXPECT_EQ(made.missed(), "");
    EXPECT_TRUE(has_note(made, "rings"));
    EXPECT_FALSE(made.trace.empty());
    const double input = made.check.of_input.volumes.at(1);
    EXPECT_NEAR(made.check.of_mesh.volumes.at(1), input, (order == 1 ? 0.02 : 0.01) * input);
    expect_count(fmt::format("volumes kept/rod of rings/order {}", order), made.result.mesh.tets.size());
  }
}

TEST(VolumesKept, OrdinaryPartsHaveNoFurtherStage) {
  const PolygonSoup soup = box();
  Execution execution;
  bool tetrahedralized = false;
  execution.progress = [&](const ProgressReport& report) {
    tetrahedralized |= report.phase == "tetrahedralize";
    return true;
  };
  EXPECT_EQ(run_pipeline({&soup, 1}, asked(0.5), execution).missed(), "");
  EXPECT_FALSE(tetrahedralized);
}

}  // namespace
}  // namespace collarmesh::volumes_kept_test
