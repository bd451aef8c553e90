#include "common/deadline.h"

#include <gtest/gtest.h>

#include <cmath>

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

}  // namespace
}  // namespace collarmesh::deadline_test
