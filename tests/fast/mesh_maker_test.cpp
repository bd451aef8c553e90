// Meshes of complexes whose refinement has exploded.
#include "pipeline/mesh_maker.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "collarmesh/plc_builder.h"
#include "pipeline/certification.h"
#include "pipeline/constrained_start.h"
#include "support/shapes.h"

namespace collarmesh::mesh_maker_test {
namespace {

using pipeline::MeshJob;
using pipeline::MeshMaker;

/// Meshes two boxes with a gap as thin as this when other ways have failed, a refinement with `tried`
/// vertices among them.
struct LastWay {
  LastWay(double gap, std::size_t tried)
      : plc(build_plc(std::vector{testing::box(), testing::box({0, 0, 1 + gap}, {1, 1, 2})})),
        job(with_size(), execution),
        maker(job, nullptr) {
    job.budget.bound(pipeline::Ways::none);
    maker.make_anyhow(plc, "the refinement exploded", tried);
  }

  static PipelineOptions with_size() {
    PipelineOptions options;
    options.mesh.size = 0.5;
    return options;
  }

  Plc plc;
  Execution execution;
  MeshJob job;
  MeshMaker maker;
};

TEST(MeshMaker, TakesConstrainedTetrahedraThatKeepEveryGuarantee) {
  const LastWay made(0.3, 0);
  EXPECT_TRUE(made.job.made.guarantees_hold());
  EXPECT_FALSE(made.maker.depends_on_seed());
  EXPECT_TRUE(made.maker.prefers_constrained());
}

TEST(MeshMaker, DoesNotRefineAgainWithTheSameBound) {
  const LastWay made(1e-7, std::numeric_limits<std::size_t>::max());
  const PipelineResult& result = made.job.made;
  ASSERT_EQ(result.result.status, MeshStatus::complete);
  EXPECT_FALSE(result.result.mesh.tets.empty());
  EXPECT_FALSE(made.maker.depends_on_seed());
  EXPECT_TRUE(std::ranges::all_of(result.check.findings, pipeline::is_about_shape));
  EXPECT_TRUE(std::ranges::any_of(result.check.notes, [](const std::string& note) {
    return note.find("the refinement exploded") != std::string::npos;
  }));
}

/// Settles the mesh of a box. The time for it runs out at the beginning of a stage.
class Settling : public ::testing::Test {
 protected:
  Settling() : plc_(build_plc(std::vector{testing::box()})) {
    execution_.progress = [this](const ProgressReport& report) {
      if (is_settling_ && report.begins)
        while (!job_->control.execution().cancelled()) std::this_thread::yield();
      ran_out_ |= is_settling_ && report.begins;
      return true;
    };
    PipelineOptions options = LastWay::with_size();
    options.start = Start::constrained;
    options.mesh.time_limit = 1e6;
    job_.emplace(options, execution_);
    MeshMaker(*job_, nullptr).make(plc_, 1);
  }

  TetMesh& mesh() { return job_->made.result.mesh; }

  void expect_unchanged() {
    const TetMesh before = mesh();
    const std::size_t candidates = job_->made.improvement.candidates;
    job_->control.attempt(1e-6, [&] {  // a second
      is_settling_ = true;
      settle(*job_, pipeline::Hope::any);
    });
    EXPECT_TRUE(ran_out_);
    EXPECT_EQ(job_->made.result.status, MeshStatus::complete);
    EXPECT_EQ(job_->made.improvement.candidates, candidates);
    EXPECT_EQ(mesh().points, before.points);
    EXPECT_EQ(mesh().tets, before.tets);
  }

  Plc plc_;
  Execution execution_;
  std::optional<MeshJob> job_;
  bool is_settling_ = false, ran_out_ = false;
};

TEST_F(Settling, KeepsAGoodMeshAtATimeLimit) {
  ASSERT_EQ(pipeline::count_misshapen(*job_, mesh()), 0U);
  expect_unchanged();
}

TEST_F(Settling, KeepsAPoorMeshAtATimeLimit) {
  const auto tet = std::ranges::find_if(
      mesh().tets, [&](const auto& corners) { return mesh().features[corners[0]].dimension == 3; });
  ASSERT_NE(tet, mesh().tets.end());
  Point& p = mesh().points[(*tet)[0]];
  p = p + 0.999 * (mesh().points[(*tet)[1]] - p);
  ASSERT_GT(pipeline::count_misshapen(*job_, mesh()), 0U);
  expect_unchanged();
}

PipelineResult with_findings(std::size_t tets, std::size_t findings, const char* guarantee = "thin_angles") {
  PipelineResult made;
  made.result.mesh.tets.resize(tets);
  made.check.findings_total = findings;
  made.check.findings.resize(std::min<std::size_t>(findings, 3));
  for (Finding& finding : made.check.findings) finding.guarantee = guarantee;
  return made;
}

TEST(MeshMaker, ComparesMeshesByTheShareOfTetsThatMissGuarantees) {
  const PipelineResult constrained = with_findings(10'000, 2);
  EXPECT_TRUE(pipeline::misses_far_less(constrained, with_findings(40'000, 10'000)));
  EXPECT_FALSE(pipeline::misses_far_less(constrained, with_findings(1'000'000, 1000))) << "only five times";
  EXPECT_FALSE(pipeline::misses_far_less(constrained, with_findings(1000, 20))) << "seeds may mend these";
  EXPECT_FALSE(pipeline::misses_far_less(constrained, with_findings(1000, 500, "volume_kept")))
      << "smaller tolerances may mend these";
}

}  // namespace
}  // namespace collarmesh::mesh_maker_test
