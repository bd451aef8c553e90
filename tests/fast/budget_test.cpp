// The resources that a refinement may use, and its result: budget and outcome.
#include "refine/budget.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "refine/outcome.h"

namespace collarmesh::budget_test {
namespace {

TEST(RefineOutcome, KeepsTheFirstMessageUnlessItIsStopped) {
  const Frame frame;
  Outcome outcome(frame);
  EXPECT_FALSE(outcome.given_up());
  outcome.give_up({1, 2, 3}, "a first thing", "do this");
  outcome.give_up({4, 5, 6}, "a second thing", "do that");
  EXPECT_EQ(outcome.message(), "a first thing near (1, 2, 3); do this");
  EXPECT_EQ(outcome.status(), MeshStatus::complete);
  outcome.stop(MeshStatus::budget_hit, {7, 8, 9}, "the end", "raise it");
  EXPECT_TRUE(outcome.stopped());
  EXPECT_EQ(outcome.status(), MeshStatus::budget_hit);
  EXPECT_EQ(outcome.message(), "the end near (7, 8, 9); raise it");
  EXPECT_EQ(outcome.where(), (Point{7, 8, 9}));
}

TEST(RefineBudget, CountsVerticesThatWillComeAndRemembersTheMostMemory) {
  const Frame frame;
  Outcome outcome(frame);
  MeshOptions options;
  options.max_vertices = 100;
  const Execution execution;
  Budget budget(options, execution, outcome);
  EXPECT_FALSE(budget.spent({60, 300, 5000, 40, {}, 1000}));
  EXPECT_FALSE(budget.spent({80, 300, 4000, 0, {}, 1000}));
  EXPECT_EQ(budget.peak_bytes(), 5000U);
  EXPECT_TRUE(budget.spent({60, 300, 4000, 41, {}, 1000}));
  EXPECT_EQ(outcome.status(), MeshStatus::budget_hit);
  EXPECT_NE(outcome.message().find("max-vertices"), std::string::npos);
}

TEST(RefineBudget, ProgressNeverGoesBackAndMayCancel) {
  const Frame frame;
  Outcome outcome(frame);
  const MeshOptions options;
  Execution execution;
  std::vector<double> told;
  execution.progress = [&](const ProgressReport& progress) {
    told.push_back(progress.fraction);
    return false;
  };
  Budget budget(options, execution, outcome);
  EXPECT_TRUE(budget.spent({10, 500, 0, 0, {}, 1000}));
  EXPECT_EQ(told, std::vector<double>{0.5});
  EXPECT_EQ(outcome.status(), MeshStatus::cancelled);
}

}  // namespace
}  // namespace collarmesh::budget_test
