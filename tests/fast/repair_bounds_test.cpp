// Repair ends: if it is cancelled, if it takes too much work, and if nothing can be enclosed.
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <string>
#include <vector>

#include "collarmesh/error.h"
#include "collarmesh/noise.h"
#include "collarmesh/repair.h"
#include "support/repair_shapes.h"
#include "support/sanitized.h"
#include "support/shapes.h"

namespace collarmesh::repair_bounds_test {
namespace {

using namespace testing::faulty;

constexpr double coarse_offset = 0.02;

PolygonSoup crossing_balls() {
  return testing::joined(testing::icosphere(1, 8),
                         testing::translated(testing::icosphere(1, 8), {0.71, 0.53, 0.37}));
}

TEST(RepairBounds, CancelledBeforeItBegins) {
  const PolygonSoup soup = crossing_balls();
  const std::atomic<bool> cancel{true};
  Execution execution;
  execution.cancel = &cancel;
  const RepairResult r = repair({&soup, 1}, {}, {}, execution);
  EXPECT_TRUE(r.report.cancelled);
  EXPECT_FALSE(r.report.repaired);
  ASSERT_EQ(r.soups.size(), 1U);
  EXPECT_EQ(r.soups[0].facet_count(), soup.facet_count());
  const RepairedPlc built = build_repaired_plc({&soup, 1}, {}, {}, execution);
  EXPECT_TRUE(built.report.cancelled);
  EXPECT_TRUE(built.plc.triangles.empty());
}

TEST(RepairBounds, GivesUpBeyondItsWork) {
  const PolygonSoup soup = crossing_balls();
  RepairOptions options;
  options.max_work = 10000;
  const RepairResult r = repair({&soup, 1}, options);
  EXPECT_TRUE(r.report.gave_up);
  EXPECT_FALSE(r.report.repaired);
  try {
    build_repaired_plc({&soup, 1}, {}, options);
    FAIL() << "it was repaired";
  } catch (const PlcError& error) {
    EXPECT_NE(std::string(error.what()).find("given up"), std::string::npos) << error.what();
    EXPECT_FALSE(error.faults.empty());
  }
  // With a large enough bound the surface is repaired; repair always takes the same amount of work.
  EXPECT_TRUE(repair({&soup, 1}).report.repaired);
  // Wrapping is not limited by this bound on work.
  options.mode = RepairMode::wrap;
  options.wrap_offset = coarse_offset;
  EXPECT_TRUE(build_repaired_plc({&soup, 1}, {}, options).report.wrapped);
}

// Whether there is noise is known before the work of removing it.
TEST(RepairBounds, NoiseIsKnownBeforeItsRepair) {
  RepairOptions off;
  off.mode = RepairMode::off;
  for (const double width : {1e-1, 1e-7}) {
    const PolygonSoup slotted = slotted_box(width);
    const Plc plc = build_plc({&slotted, 1}, {});
    EXPECT_EQ(has_noise(plc), width < RepairOptions{}.tolerance) << width;
    EXPECT_FALSE(has_noise(plc, off)) << width;
    EXPECT_EQ(remove_noise(plc, {&slotted, 1}).report.repaired, has_noise(plc)) << width;
  }
}

// If features of a valid complex cannot be removed within the work, they stay, with a warning.
TEST(RepairBounds, NoiseThatStaysIsTold) {
  const PolygonSoup slotted = slotted_box(1e-7);
  RepairOptions options;
  options.max_work = 1;
  const RepairedPlc r = build_repaired_plc({&slotted, 1}, {}, options);
  EXPECT_FALSE(r.report.repaired);
  ASSERT_FALSE(r.plc.warnings.empty());
  EXPECT_NE(r.plc.warnings.back().message.find("below the repair tolerance"), std::string::npos);
  EXPECT_TRUE(std::isfinite(r.plc.warnings.back().where.x));
  const RepairedPlc repaired = build_repaired_plc({&slotted, 1});
  EXPECT_TRUE(repaired.report.repaired);
  EXPECT_TRUE(repaired.plc.warnings.empty());
}

// A curved sheet with a long border: neither stitching nor filling makes a solid of it.
TEST(RepairBounds, OpenSheetsAreRefused) {
  constexpr Index n = testing::sanitized ? 20 : 100;
  PolygonSoup sheet;
  for (Index j = 0; j <= n; ++j)
    for (Index i = 0; i <= n; ++i) {
      const double u = 3.0 * i / n, v = 6.0 * j / n;
      sheet.points.push_back({u, v, 0.4 * std::sin(2 * u) * std::cos(v)});
    }
  for (Index j = 0; j < n; ++j)
    for (Index i = 0; i < n; ++i) {
      const Index p = j * (n + 1) + i;
      sheet.add_facet(std::array<Index, 3>{p, p + 1, p + n + 2}, 1);
      sheet.add_facet(std::array<Index, 3>{p, p + n + 2, p + n + 1}, 1);
    }
  EXPECT_THROW(build_repaired_plc({&sheet, 1}), PlcError);
}

TEST(RepairBounds, FurtherRepairsAreCoarserAndThenWrap) {
  RepairReport nothing, repaired, wrapped;
  repaired.repaired = wrapped.repaired = wrapped.wrapped = true;
  RepairOptions options;
  const double tolerance = options.tolerance;
  EXPECT_TRUE(further_repairs(options, nothing).empty());
  EXPECT_TRUE(further_repairs(options, wrapped).empty());
  ASSERT_EQ(further_repairs(options, repaired).size(), 1U);
  EXPECT_DOUBLE_EQ(further_repairs(options, repaired)[0].tolerance, 3 * tolerance);
  options.mode = RepairMode::wrap;
  ASSERT_EQ(further_repairs(options, nothing).size(), 1U);
  EXPECT_TRUE(further_repairs(options, nothing)[0].wrap_at_once);
  ASSERT_EQ(further_repairs(options, repaired).size(), 2U);
  EXPECT_FALSE(further_repairs(options, repaired)[0].wrap_at_once);
  EXPECT_TRUE(further_repairs(options, repaired)[1].wrap_at_once);
  EXPECT_TRUE(further_repairs(options, wrapped).empty());
  options.tolerance = 5e-3;  // three times this would be 1.5% of the diagonal
  EXPECT_EQ(further_repairs(options, repaired).size(), 1U);
  options.mode = RepairMode::off;
  EXPECT_TRUE(further_repairs(options, repaired).empty());
}

TEST(RepairBounds, CoarserRepairsKeepBelowTheSize) {
  const auto tolerances = [](RepairOptions options, double size) {
    std::vector<double> list;
    for (const RepairOptions& repair : coarser_repairs(options, size, 20)) list.push_back(repair.tolerance);
    return list;
  };
  RepairOptions options;
  EXPECT_EQ(tolerances(options, 2), (std::vector<double>{1e-4, 1e-3}));
  EXPECT_EQ(tolerances(options, 1), (std::vector<double>{1e-4, 5e-4}));
  EXPECT_EQ(tolerances(options, 0.3), (std::vector<double>{1e-4}));
  ASSERT_EQ(tolerances(options, 0.11).size(), 1U);
  EXPECT_DOUBLE_EQ(tolerances(options, 0.11).front(), 5.5e-5);
  EXPECT_TRUE(tolerances(options, 0.01).empty());
  options.tolerance = 2e-4;
  EXPECT_EQ(tolerances(options, 2), (std::vector<double>{1e-3}));
  options.tolerance = 1e-2;
  EXPECT_TRUE(tolerances(options, 2).empty());
  options = {};
  options.mode = RepairMode::off;
  EXPECT_TRUE(tolerances(options, 2).empty());
}

TEST(RepairBounds, WrapsAtOnce) {
  const PolygonSoup box = testing::box();
  RepairOptions options;
  options.mode = RepairMode::wrap;
  EXPECT_FALSE(build_repaired_plc({&box, 1}, {}, options).report.repaired);
  options.wrap_at_once = true;
  options.wrap_offset = coarse_offset;
  const RepairedPlc wrapped = build_repaired_plc({&box, 1}, {}, options);
  EXPECT_TRUE(wrapped.report.wrapped);
  EXPECT_GT(wrapped.plc.regions[1].volume, 1);
}

}  // namespace
}  // namespace collarmesh::repair_bounds_test
