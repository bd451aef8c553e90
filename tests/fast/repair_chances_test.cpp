// Which vertices get trials with repairs after many trials have failed.
#include "coarsen/repair_chances.h"

#include <gtest/gtest.h>

namespace collarmesh::repair_chances_test {
namespace {

using remeshing::coarsening::RepairChances;

// Returns the share of places that are due, where `step` is the distance of these places.
double share_due(const RepairChances& chances, std::size_t step = 1) {
  constexpr std::size_t places = 1 << 16;
  std::size_t due = 0;
  for (std::size_t i = 0; i < places; ++i) due += chances.is_due(i * step) ? 1 : 0;
  return static_cast<double>(due) / places;
}

void fail(RepairChances& chances, std::size_t times) {
  for (std::size_t i = 0; i < times; ++i) chances.note_failure();
}

TEST(RepairChances, AreHalvedByFailuresInARowAndDoubledBySuccesses) {
  constexpr double rounding = 0.01;
  RepairChances chances;
  EXPECT_EQ(share_due(chances), 1);
  fail(chances, RepairChances::many - 1);
  chances.note_success();
  fail(chances, RepairChances::many - 1);
  EXPECT_EQ(share_due(chances), 1) << "never enough failures in a row";
  fail(chances, 1);
  EXPECT_NEAR(share_due(chances), 0.5, rounding);
  fail(chances, 2 * RepairChances::many);
  EXPECT_NEAR(share_due(chances), 0.125, rounding);
  chances.note_success();
  EXPECT_NEAR(share_due(chances), 0.25, rounding);
  chances.note_success();
  chances.note_success();
  chances.note_success();
  EXPECT_EQ(share_due(chances), 1);
}

TEST(RepairChances, AlwaysLeaveSomeVerticesOfEachNeighbourhood) {
  RepairChances chances;
  fail(chances, 100 * RepairChances::many);
  constexpr std::size_t longest_gap = 1500;  // 64 ln(65,536) is 710
  for (const std::size_t step : {1, 2, 64, 100, 113, 226, 244, 250, 256}) {
    EXPECT_NEAR(share_due(chances, step), 1. / RepairChances::most, 0.005) << step;
    std::size_t gap = 0;
    for (std::size_t i = 0; i < 1 << 16; ++i) {
      gap = chances.is_due(i * step) ? 0 : gap + 1;
      ASSERT_LT(gap, longest_gap) << step;
    }
  }
}

}  // namespace
}  // namespace collarmesh::repair_chances_test
