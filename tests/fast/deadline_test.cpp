#include "common/deadline.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <thread>
#include <vector>

#include "collarmesh/error.h"
#include "common/run_control.h"

namespace collarmesh::deadline_test {
namespace {

TEST(CommonDeadline, NeverPassesWithoutALimit) {
  for (const Deadline deadline : {Deadline(), Deadline::in(0)}) {
    EXPECT_FALSE(deadline.exists());
    EXPECT_FALSE(deadline.passed());
    EXPECT_TRUE(std::isinf(deadline.remaining()));
    EXPECT_EQ(deadline.as_option(), 0);
  }
}

TEST(CommonDeadline, PassesAtItsTime) {
  const Deadline past = Deadline::in(1e-12), future = Deadline::in(1e300);
  while (past.remaining() >= 0) {
  }
  EXPECT_TRUE(past.exists());
  EXPECT_TRUE(past.passed());
  EXPECT_FALSE(past.passed(1e6));
  EXPECT_GT(past.as_option(), 0);  // 0 would mean that there is no limit
  EXPECT_FALSE(future.passed());
  EXPECT_GT(future.remaining(), 2e7);
}

// RunControl

TEST(RunControl, AStageThatItsProgressEndedEndsTheRun) {
  for (const bool goes_on : {true, false}) {
    PipelineResult made;
    Execution execution;
    std::vector<double> told;
    execution.progress = [&](const ProgressReport& report) {
      told.push_back(report.fraction);
      return report.begins || goes_on;
    };
    RunControl control({}, execution, made);
    control.begin("check", 0.5, 0.9);
    bool went_on = false;
    const auto stage = [&](const Execution& watched) { went_on = watched.progress({"check", 0.5}); };
    if (goes_on) {
      control.watch(stage);
    } else {
      EXPECT_THROW(control.watch(stage), Ended);
      EXPECT_EQ(made.result.status, MeshStatus::cancelled);
      EXPECT_EQ(made.result.message, "the run was stopped (check)");
    }
    EXPECT_EQ(went_on, goes_on);
    ASSERT_EQ(told.size(), 2U);
    EXPECT_NEAR(told[1], 0.7, 1e-12) << "the middle of its share of the run";
  }
}

/// A run whose time limit is far away.
struct LongRun {
  PipelineResult made;
  const Execution execution = {};
  RunControl control{[] {
                       PipelineOptions options;
                       options.mesh.time_limit = 1000;
                       return options;
                     }(),
                     execution, made};
};

TEST(RunControl, AnAttemptThatFailsGivesItsTimeBack) {
  LongRun run;
  RunControl& control = run.control;
  const std::atomic<bool>* const flag = control.execution().cancel;
  EXPECT_THROW(control.attempt(1e-9,
                               [&] {
                                 EXPECT_NE(control.execution().cancel, flag);
                                 while (!control.execution().cancelled()) std::this_thread::yield();
                                 EXPECT_TRUE(control.out_of_time());
                                 throw OptionError("no such tag");
                               }),
               OptionError);
  EXPECT_EQ(control.execution().cancel, flag);
  EXPECT_FALSE(control.out_of_time());
  EXPECT_NO_THROW(control.stop_if_asked());
}

TEST(RunControl, AttemptsMayContainAttempts) {
  LongRun run;
  RunControl& control = run.control;
  const auto wait = [&] {
    while (!control.execution().cancelled()) std::this_thread::yield();
    EXPECT_TRUE(control.out_of_time());
  };
  control.attempt(0.5, [&] {
    control.attempt(1e-9, wait);
    EXPECT_FALSE(control.execution().cancelled()) << "the outer attempt has time left";
    EXPECT_FALSE(control.out_of_time());
  });
  control.attempt(1e-9, [&] { control.attempt(0.5, wait); });
  EXPECT_FALSE(control.execution().cancelled());
  EXPECT_FALSE(control.out_of_time());
}

}  // namespace
}  // namespace collarmesh::deadline_test
