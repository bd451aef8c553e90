// Wrapping: a closed surface around the whole input.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "collarmesh/error.h"
#include "collarmesh/repair.h"
#include "repair/wrap.h"
#include "support/sanitized.h"
#include "support/shapes.h"

namespace collarmesh::testing::repair_wrap_test {
namespace {

using repairing::build_wrapped_plc;
using repairing::largest_distance_from;
using repairing::wrap;

PolygonSoup square() {
  PolygonSoup soup;
  soup.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  soup.add_facet(std::array<Index, 4>{0, 1, 2, 3}, 5);
  return soup;
}

TEST(Wrap, EnclosesABoxAtTheOffset) {
  constexpr double offset = sanitized ? 0.06 : 0.02;
  const std::vector<PolygonSoup> input{box()};
  const std::vector<PolygonSoup> wrapped{wrap(input, 2 * offset, offset)};
  const Plc plc = build_plc(wrapped);
  ASSERT_EQ(plc.regions.size(), 2U);
  EXPECT_GT(plc.regions[1].volume, std::pow(1 + 2 * offset / std::sqrt(3), 3));
  EXPECT_LT(plc.regions[1].volume, std::pow(1 + 2 * offset, 3));
  const double distance = largest_distance_from(input, wrapped.front());
  EXPECT_GE(distance, offset * (1 - 1e-3));
  EXPECT_LT(distance, 2 * offset);
}

TEST(Wrap, TagsAreOne) {
  const PolygonSoup wrapped = wrap(std::vector{box()}, 0.2, 0.1);
  ASSERT_GT(wrapped.facet_count(), 0U);
  for (Index f = 0; f < wrapped.facet_count(); ++f) EXPECT_EQ(wrapped.facet_tag(f), 1);
}

TEST(Wrap, GivesSheetsAVolume) {
  const std::vector<PolygonSoup> input{square()};
  RepairOptions options;
  options.wrap_offset = 0.01;
  const auto wrapped = build_wrapped_plc(input, {}, options);
  ASSERT_TRUE(wrapped.has_value());
  EXPECT_TRUE(wrapped->report.repaired && wrapped->report.wrapped);
  const double offset = options.wrap_offset * std::sqrt(2.0);
  EXPECT_NEAR(wrapped->report.largest_distance, offset, 0.5 * offset);
  EXPECT_GT(wrapped->plc.regions.at(1).volume, 2 * 0.9 * offset);
  EXPECT_EQ(wrapped->report.lost_tags, std::vector<Tag>{}) << "one tag says nothing";
}

TEST(Wrap, LostTagsAreTold) {
  RepairOptions options;
  options.wrap_offset = 0.02;
  const auto wrapped = build_wrapped_plc(std::vector{box()}, {}, options);
  ASSERT_TRUE(wrapped.has_value());
  EXPECT_EQ(wrapped->report.lost_tags, (std::vector<Tag>{2, 3, 4, 5, 6}));
}

TEST(Wrap, NothingHasNone) {
  EXPECT_EQ(wrap({}, 0.2, 0.1).facet_count(), 0U);
  EXPECT_FALSE(build_wrapped_plc({}, {}, {}).has_value());
  PolygonSoup needle;
  needle.points = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  needle.add_facet(std::array<Index, 3>{0, 1, 2});
  EXPECT_FALSE(build_wrapped_plc(std::vector{needle}, {}, {}).has_value());
}

TEST(Wrap, PointsThatAreNotFiniteAreErrors) {
  PolygonSoup soup = square();
  soup.points[0].x = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(wrap(std::vector{soup}, 0.2, 0.1), PlcError);
}

// Wrapping is the last resort: input that can be repaired is not wrapped.
TEST(Wrap, OnRequestAndWhereRepairFails) {
  RepairOptions options;
  options.mode = RepairMode::wrap;
  if (sanitized) options.wrap_offset = 0.05;
  EXPECT_FALSE(build_repaired_plc(std::vector{box()}, {}, options).report.repaired);
  const std::vector<PolygonSoup> overlapping{box(), box({0.5, 0.5, 0.5}, {2, 2, 2})};
  EXPECT_FALSE(build_repaired_plc(overlapping, {}, options).report.wrapped);
  EXPECT_TRUE(build_repaired_plc(std::vector{square()}, {}, options).report.wrapped);
  options.mode = RepairMode::automatic;
  EXPECT_THROW(build_repaired_plc(std::vector{square()}, {}, options), PlcError);
}

}  // namespace
}  // namespace collarmesh::testing::repair_wrap_test
