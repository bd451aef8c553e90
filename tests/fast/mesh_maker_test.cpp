// Meshes of complexes whose refinement has exploded.
#include "pipeline/mesh_maker.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "collarmesh/plc_builder.h"
#include "pipeline/certification.h"
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
