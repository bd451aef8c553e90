// Budgets, cancelling, progress and invalid options of `generate`.
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <limits>
#include <thread>

#include "collarmesh/error.h"
#include "support/meshing.h"
#include "support/shapes.h"

namespace collarmesh::refinement_control_test {
namespace {

using testing::with_size;

Plc box_complex() {
  const PolygonSoup soup = testing::box();
  return build_plc({&soup, 1});
}

void expect_no_mesh(const MeshResult& result, MeshStatus status) {
  EXPECT_EQ(result.status, status);
  for (const char* told : {"vertices and ", " cells, ", " MB, after ", "the last vertex is near (", "); "})
    EXPECT_NE(result.message.find(told), std::string::npos) << result.message;
  EXPECT_TRUE(result.mesh.points.empty());
  EXPECT_TRUE(result.mesh.tets.empty());
}

// Each budget is far below what the mesh needs.
TEST(RefinementBudget, Vertices) {
  MeshOptions options = with_size(0.02);
  options.max_vertices = 2000;
  const MeshResult result = generate(box_complex(), options);
  expect_no_mesh(result, MeshStatus::budget_hit);
  EXPECT_NE(result.message.find("2000 vertices"), std::string::npos) << result.message;
  EXPECT_NE(result.message.find("raise max-vertices"), std::string::npos) << result.message;
  EXPECT_LT(result.statistics.vertices_inserted, 4000U);
}

TEST(RefinementBudget, Memory) {
  MeshOptions options = with_size(0.02);
  options.max_memory = 2'000'000;
  const MeshResult result = generate(box_complex(), options);
  expect_no_mesh(result, MeshStatus::budget_hit);
  EXPECT_NE(result.message.find("bytes"), std::string::npos) << result.message;
  EXPECT_NE(result.message.find("raise max-memory"), std::string::npos) << result.message;
}

TEST(RefinementBudget, Time) {
  MeshOptions options = with_size(0.005);
  options.time_limit = 0.1;
  const MeshResult result = generate(box_complex(), options);
  expect_no_mesh(result, MeshStatus::budget_hit);
  EXPECT_NE(result.message.find("time limit"), std::string::npos) << result.message;
  EXPECT_NE(result.message.find("raise time-limit"), std::string::npos) << result.message;
}

// Progress is reported even if the whole mesh takes few steps.
TEST(RefinementBudget, OfASmallMesh) {
  MeshOptions options = with_size(0.4);
  options.max_vertices = 20;
  expect_no_mesh(generate(box_complex(), options), MeshStatus::budget_hit);
}

TEST(RefinementBudget, EnoughIsNoHindrance) {
  MeshOptions options = with_size(0.2);
  options.max_vertices = 100'000;
  options.max_memory = 1'000'000'000;
  EXPECT_EQ(testing::faults(testing::mesh_of(box_complex(), options)), "");
}

TEST(RefinementCancel, ByTheFlagFromAnotherThread) {
  std::atomic<bool> cancel = false, begun = false;
  Execution execution;
  execution.cancel = &cancel;
  execution.progress = [&](const auto&...) {
    begun = true;
    return true;
  };
  std::thread other([&] {
    while (!begun) std::this_thread::yield();
    cancel = true;
  });
  const MeshResult result = generate(box_complex(), with_size(0.005), execution);
  other.join();
  expect_no_mesh(result, MeshStatus::cancelled);
}

TEST(RefinementCancel, BeforeTheStart) {
  const std::atomic<bool> cancel = true;
  Execution execution;
  execution.cancel = &cancel;
  expect_no_mesh(generate(box_complex(), with_size(0.4), execution), MeshStatus::cancelled);
}

TEST(RefinementCancel, ByTheProgressCallback) {
  unsigned calls = 0;
  Execution execution;
  execution.progress = [&](const ProgressReport&) { return ++calls < 3; };
  expect_no_mesh(generate(box_complex(), with_size(0.005), execution), MeshStatus::cancelled);
  EXPECT_EQ(calls, 3U);
}

TEST(RefinementProgress, FractionsNeverDecrease) {
  std::vector<ProgressReport> reports;
  Execution execution;
  execution.progress = [&](const ProgressReport& report) {
    reports.push_back(report);
    return true;
  };
  EXPECT_EQ(generate(box_complex(), with_size(0.025), execution).status, MeshStatus::complete);
  ASSERT_GE(reports.size(), 2U);
  for (std::size_t i = 0; i < reports.size(); ++i) {
    EXPECT_GE(reports[i].fraction, i == 0 ? 0 : reports[i - 1].fraction);
    EXPECT_LE(reports[i].fraction, 1);
    EXPECT_FALSE(reports[i].phase.empty());
  }
  EXPECT_GT(reports.back().vertices, 0U);
  EXPECT_GT(reports.back().tets, 0U);
}

struct BadOption {
  std::string name;
  std::function<void(MeshOptions&)> spoil;
};

std::vector<BadOption> bad_options() {
  using Options = MeshOptions&;
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  return {{"size", [](Options o) { o.size = -1; }},
          {"size not a number", [](Options o) { o.size = nan; }},
          {"size_min", [](Options o) { o.size_min = -1; }},
          {"size_min above size", [](Options o) { o.size = 1, o.size_min = 2; }},
          {"distance", [](Options o) { o.bounds.distance = -1; }},
          {"gradation", [](Options o) { o.gradation = -0.1; }},
          {"gradation not a number", [](Options o) { o.gradation = nan; }},
          {"region size", [](Options o) { o.region_size[1] = 0; }},
          {"patch size", [](Options o) { o.patch_size[1] = -1; }},
          {"curve size", [](Options o) { o.curve_size[1] = nan; }},
          {"radius_edge", [](Options o) { o.bounds.radius_edge = 0.99; }},
          {"radius_edge not a number", [](Options o) { o.bounds.radius_edge = nan; }},
          {"exterior below 1", [](Options o) { o.exterior_radius_edge = 0.9; }},
          {"vertex_ratio", [](Options o) { o.vertex_ratio = 2.8; }},
          {"vertex_ratio below zero", [](Options o) { o.vertex_ratio = -4; }},
          {"theta", [](Options o) { o.theta = -0.1; }},
          {"large theta", [](Options o) { o.theta = 0.5; }},
          {"crease_angle", [](Options o) { o.bounds.crease_angle = -1; }},
          {"obtuse crease_angle", [](Options o) { o.bounds.crease_angle = 91; }},
          {"crease_angle not a number", [](Options o) { o.bounds.crease_angle = nan; }},
          {"collar_angle", [](Options o) { o.bounds.collar_angle = 99; }},
          {"large collar_angle", [](Options o) { o.bounds.collar_angle = 176; }},
          {"representation_angle", [](Options o) { o.representation_angle = 0; }},
          {"large representation_angle", [](Options o) { o.representation_angle = 90; }},
          {"time_limit", [](Options o) { o.time_limit = -1; }}};
}

TEST(RefinementOptions, BadOnesAreRefused) {
  const Plc plc = box_complex();
  for (const BadOption& bad : bad_options()) {
    MeshOptions options = with_size(0);
    bad.spoil(options);
    EXPECT_THROW(generate(plc, options), OptionError) << bad.name;
  }
}

TEST(RefinementOptions, WithoutThinTetsAMeshIsRefinedButNotCoarsened) {
  MeshOptions options = with_size(0.5);
  options.bounds.thin_angle = 0;
  EXPECT_EQ(generate(box_complex(), options).status, MeshStatus::complete);
}

}  // namespace
}  // namespace collarmesh::refinement_control_test
