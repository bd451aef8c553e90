// The predicates that judge a whole mesh, and the parts of a mesh on several ranks.
#include "check/predicates.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>
#include <utility>

namespace collarmesh::checks::check_predicates_test {
namespace {

using Corners = std::array<Point, 4>;

constexpr Corners unit{Point{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

/// Returns a straight tet of second order.
CurvedTet with_middles(const Corners& p) {
  const auto middle = [&](unsigned i, unsigned j) { return 0.5 * (p[i] + p[j]); };
  return {p[0],         p[1],         p[2],         p[3],         middle(0, 1),
          middle(1, 2), middle(2, 0), middle(0, 3), middle(1, 3), middle(2, 3)};
}

class CheckPredicates : public ::testing::Test {
 protected:
  std::string message() const { return report_.findings.at(0).message; }

  CheckReport report_;
  Findings findings_{report_, 20};
};

TEST_F(CheckPredicates, ATetHasPositiveVolume) {
  EXPECT_TRUE(check_orientation({"Tet", 7}, unit, 1.0 / 6, findings_));
  EXPECT_EQ(report_.findings_total, 0U);
  Corners flat = unit, inverted = unit;
  flat[3] = {0.5, 0.25, 0};
  std::swap(inverted[0], inverted[1]);
  EXPECT_FALSE(check_orientation({"Tet", 7}, flat, 0, findings_));
  EXPECT_FALSE(check_orientation({"Tet", 7}, inverted, -1.0 / 6, findings_));
  ASSERT_EQ(report_.findings.size(), 2U);
  EXPECT_EQ(report_.findings[0].guarantee, guarantee::positive_volume);
  EXPECT_NE(message().find("Tet 7 with corners"), std::string::npos);
  EXPECT_NE(message().find("is flat"), std::string::npos);
  EXPECT_NE(report_.findings[1].message.find("is inverted"), std::string::npos);
}

TEST_F(CheckPredicates, AnEntityOfOneRankHasNoNumber) {
  Corners inverted = unit;
  std::swap(inverted[0], inverted[1]);
  check_orientation({"Tet"}, inverted, -1.0 / 6, findings_);
  EXPECT_EQ(message().rfind("Tet with corners", 0), 0U) << message();
}

TEST_F(CheckPredicates, ACurvedTetIsValidEverywhere) {
  CurvedTet nodes = with_middles(unit);
  check_jacobian({"Tet", 3}, nodes, 5, findings_);
  nodes[4] = {0.45, 0.05, 0.05};
  check_jacobian({"Tet", 3}, nodes, 5, findings_);
  EXPECT_EQ(report_.findings_total, 0U);
  nodes[4] = {0.95, 0, 0};  // the edge folds at its end
  check_jacobian({"Tet", 3}, nodes, 5, findings_);
  ASSERT_EQ(report_.findings.size(), 1U);
  EXPECT_EQ(report_.findings[0].guarantee, guarantee::positive_jacobian);
}

TEST_F(CheckPredicates, ANodeLiesOnItsFeature) {
  const NamedFeature curve{"curve", 2, 9};
  check_off_feature(guarantee::curve_distance, {"The vertex"}, {1, 2, 3}, 0.1, 0.1, curve, findings_);
  EXPECT_EQ(report_.findings_total, 0U);
  for (const double off : {0.2, static_cast<double>(NAN)})
    check_off_feature(guarantee::curve_distance, {"The vertex"}, {1, 2, 3}, off, 0.1, curve, findings_);
  EXPECT_EQ(report_.findings_total, 2U);
  EXPECT_EQ(report_.findings[0].guarantee, guarantee::curve_distance);
  EXPECT_NE(message().find("its curve 2 (tag 9)"), std::string::npos);
}

TEST_F(CheckPredicates, TheEdgesOfACurveAreOneChain) {
  const NamedFeature curve{"curve", 2, 9};
  EXPECT_TRUE(check_edges_at(curve, {1, 2, 3}, 2, 2, findings_));
  EXPECT_FALSE(check_edges_at(curve, {1, 2, 3}, 3, 2, findings_));
  ASSERT_EQ(report_.findings.size(), 1U);
  EXPECT_EQ(report_.findings[0].guarantee, guarantee::curve_cover);
  EXPECT_NE(message().find("curve 2 (tag 9) has 3 edges, not 2"), std::string::npos) << message();
}

TEST_F(CheckPredicates, MeasuresAreThoseOfTheComplex) {
  const NamedFeature part{"region", none, 4};
  check_measure(volume_of_region, part, {}, 1, 1.5, 0.5, findings_);
  EXPECT_EQ(report_.findings_total, 0U);
  check_measure(volume_of_region, part, {}, 1, 1.5, 0.4, findings_);
  check_measure(area_of_patch, {"patch", 3, 5}, {}, NAN, 1, 1, findings_);
  ASSERT_EQ(report_.findings.size(), 2U);
  EXPECT_EQ(report_.findings[0].guarantee, guarantee::region_volume);
  EXPECT_EQ(report_.findings[1].guarantee, guarantee::patch_area);
  EXPECT_NE(message().find("The volume of the region with tag 4 is 1 in the mesh"), std::string::npos)
      << message();
}

}  // namespace
}  // namespace collarmesh::checks::check_predicates_test
