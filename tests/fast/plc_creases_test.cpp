#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "collarmesh/plc_builder.h"
#include "plc/angles.h"
#include "support/plc_shapes.h"

namespace collarmesh::plc_creases_test {
namespace {

using std::numbers::pi;
using Kind = Crease::Kind;

Plc build(const PolygonSoup& soup, double feature_angle = 30) {
  PlcOptions options;
  options.feature_angle = feature_angle;
  return build_plc({&soup, 1}, options);
}

std::vector<Crease> of_kind(std::vector<Crease> creases, Kind kind) {
  std::erase_if(creases, [&](const Crease& c) { return c.kind != kind; });
  return creases;
}

TEST(PlcCreases, BoxHasNone) {
  const Plc plc = build(testing::moved(testing::polygonal_box({0, 0, 0}, {1, 2, 3}), 1, 1, 10));
  EXPECT_TRUE(find_creases(plc).empty());
  EXPECT_NEAR(summarize(plc).smallest_angle, 90, 1e-9);
}

TEST(PlcCreases, WedgesOfManyAngles) {
  for (const double angle : {0.1, 1.0, 5.0, 30.0, 60.0, 70.0, 71.0, 89.0}) {
    const Plc plc = build(testing::moved(testing::wedge(angle, 2), 7, 1, 3));
    const auto facets = of_kind(find_creases(plc, 90), Kind::facets);
    ASSERT_FALSE(facets.empty()) << angle;
    const double smallest = std::min(angle, (180 - angle) / 2);
    EXPECT_NEAR(facets[0].angle, smallest, 1e-6);
    EXPECT_EQ(find_creases(plc, 70.53).empty(), smallest >= 70.53);
    EXPECT_EQ(plc.curves[facets[0].curve].patches.size(), 2U);
  }
}

TEST(PlcCreases, AngleAtTheThresholdIsNotBelowIt) {
  const Plc plc = build(testing::moved(testing::wedge(75, 2), 2, 1, 0));
  EXPECT_TRUE(find_creases(plc, (180 - 75) / 2.0).empty());
  EXPECT_FALSE(find_creases(plc, (180 - 75) / 2.0 + 1e-4).empty());
}

TEST(PlcCreases, OutsideAngleOfAReflexEdgeCounts) {
  // A notch of 40 degrees in a block: the solid has 320 degrees there.
  const double half = std::tan(20 * pi / 180);
  PolygonSoup soup;
  std::vector<Index> bottom, top;
  const std::vector<Point> outline{{-2, -2, 0}, {2, -2, 0},    {2, 1, 0}, {half, 1, 0},
                                   {0, 0, 0},   {-half, 1, 0}, {-2, 1, 0}};
  const auto n = static_cast<Index>(outline.size());
  for (Index i = 0; i < n; ++i) {
    soup.points.push_back(outline[i]);
    soup.points.push_back(outline[i] + Point{0, 0, 1});
    bottom.push_back(2 * (n - 1 - i));
    top.push_back(2 * i + 1);
    const Index j = (i + 1) % n;
    soup.add_facet(std::array<Index, 4>{2 * i, 2 * j, 2 * j + 1, 2 * i + 1});
  }
  soup.add_facet(bottom);
  soup.add_facet(top);
  const auto facets = of_kind(find_creases(build(soup)), Kind::facets);
  ASSERT_EQ(facets.size(), 1U);
  EXPECT_NEAR(facets[0].angle, 40, 1e-9);
}

TEST(PlcCreases, RegularTetrahedron) {
  PolygonSoup soup;
  soup.points = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
  for (const auto& t : {std::array<Index, 3>{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}}) soup.add_facet(t);
  const auto creases = find_creases(build(soup), 70);
  EXPECT_TRUE(of_kind(creases, Kind::facets).empty());
  const auto segments = of_kind(creases, Kind::segments);
  ASSERT_EQ(segments.size(), 4U);
  EXPECT_NEAR(segments[0].angle, 60, 1e-9);
  const auto mixed = of_kind(creases, Kind::segment_and_facet);
  ASSERT_EQ(mixed.size(), 4U);
  EXPECT_NEAR(mixed[0].angle, std::atan(std::numbers::sqrt2) * 180 / pi, 1e-9);
  EXPECT_NEAR(of_kind(find_creases(build(soup), 80), Kind::facets)[0].angle, std::acos(1.0 / 3) * 180 / pi,
              1e-9);
}

TEST(PlcCreases, PyramidSidesMeetInTheApex) {
  // Opposite sides of a square pyramid meet only in its apex.
  const auto creases = find_creases(build(testing::polygonal_cone(4, 60, 1)), 89);
  const auto meeting = of_kind(creases, Kind::facets_in_vertex);
  ASSERT_EQ(meeting.size(), 1U);
  // The nearest rays of two opposite sides are edges of the side between them.
  const double radius = std::tan(30 * pi / 180);
  EXPECT_NEAR(meeting[0].angle,
              2 * std::asin(radius / std::numbers::sqrt2 / std::hypot(1, radius)) * 180 / pi, 1e-6);
  EXPECT_NE(meeting[0].vertex, none);
}

TEST(PlcCreases, ConeApexFolds) {
  for (const double aperture : {5.0, 20.0, 45.0, 65.0, 75.0, 88.0}) {
    const Plc plc = build(testing::moved(testing::polygonal_cone(100, aperture, 1), 9, 1, 2));
    ASSERT_EQ(plc.patches.size(), 2U) << aperture;
    const auto folds = of_kind(find_creases(plc, 89), Kind::patch_fold);
    ASSERT_EQ(folds.size(), 1U) << aperture;
    EXPECT_NEAR(folds[0].angle, aperture, 0.1);
    ASSERT_NE(folds[0].vertex, none);
    EXPECT_EQ(plc.points[plc.vertices[folds[0].vertex].point], folds[0].where);
    EXPECT_EQ(plc.vertices[folds[0].vertex].patches, std::vector<Index>{folds[0].features[0]});
    EXPECT_TRUE(plc.vertices[folds[0].vertex].curves.empty());
    EXPECT_EQ(of_kind(find_creases(plc, 70.53), Kind::patch_fold).empty(), aperture > 70.53);
  }
}

TEST(PlcCreases, SmoothPatchesDoNotFold) {
  for (const PolygonSoup& soup : {testing::sphere(4, 1, {0, 0, 0}), testing::sphere(30, 1, {5, 5, 5}),
                                  testing::polygonal_cylinder(24, 1, 3), testing::polygonal_cone(40, 120, 1)})
    EXPECT_TRUE(of_kind(find_creases(build(soup), 89), Kind::patch_fold).empty());
}

TEST(PlcCreases, SegmentThatMeetsAFacetFromInside) {
  PolygonSoup soup = testing::subdivided_box({0, 0, 0}, {1, 1, 1}, 2);
  const auto foot = static_cast<Index>(std::find(soup.points.begin(), soup.points.end(), Point{0.5, 0.5, 0}) -
                                       soup.points.begin());
  soup.points.push_back({0.5 + 0.3, 0.5, 0.3});
  soup.segments.push_back({foot, static_cast<Index>(soup.points.size() - 1), 0});
  const auto creases = find_creases(build(soup));
  ASSERT_EQ(creases.size(), 1U);
  EXPECT_EQ(creases[0].kind, Kind::segment_and_facet);
  EXPECT_NEAR(creases[0].angle, 45, 1e-9);
}

TEST(PlcCreases, AllPairsOfSheetsAtASegment) {
  // A fan of sheets on one segment inside a box: the smallest angle is between neighbours.
  PolygonSoup soup = testing::polygonal_box({-2, -2, -1}, {2, 2, 2});
  soup.points.push_back({0, 0, 0});
  soup.points.push_back({0, 0, 1});
  for (const double degrees : {0.0, 100.0, 125.0, 250.0}) {
    const double t = degrees * pi / 180;
    const auto i = static_cast<Index>(soup.points.size());
    soup.points.push_back({std::cos(t), std::sin(t), 0});
    soup.points.push_back({std::cos(t), std::sin(t), 1});
    soup.add_facet(std::array<Index, 4>{8, i, i + 1, 9});
  }
  const auto facets = of_kind(find_creases(build(soup)), Kind::facets);
  ASSERT_EQ(facets.size(), 1U);
  EXPECT_NEAR(facets[0].angle, 25, 1e-9);
}

TEST(PlcCreases, DescriptionsNameWhatMeetsWhere) {
  const Plc plc = build(testing::wedge(40, 2));
  const auto creases = find_creases(plc);
  const std::string sentence = describe(plc, of_kind(creases, Kind::facets)[0]);
  EXPECT_NE(sentence.find("40.00 degrees"), std::string::npos) << sentence;
  EXPECT_NE(sentence.find("(0, 0, 1)"), std::string::npos) << sentence;
  for (const Crease& c : creases) EXPECT_EQ(describe(plc, c).back(), '.');
}

TEST(PlcCreases, DescriptionsOfPatchesThatMeetInAPointOrFold) {
  const Plc pyramid = build(testing::polygonal_cone(4, 60, 1));
  const auto meeting = of_kind(find_creases(pyramid, 89), Kind::facets_in_vertex);
  ASSERT_EQ(meeting.size(), 1U);
  const std::string meets = describe(pyramid, meeting[0]);
  EXPECT_NE(meets.find(" only in the point "), std::string::npos) << meets;
  EXPECT_NE(meets.find("at " + fmt::format("{:.2f}", meeting[0].angle) + " degrees."), std::string::npos)
      << meets;
  const Plc cone = build(testing::polygonal_cone(100, 20, 1));
  const auto folds = of_kind(find_creases(cone, 89), Kind::patch_fold);
  ASSERT_EQ(folds.size(), 1U);
  const std::string folded = describe(cone, folds[0]);
  EXPECT_NE(folded.find(" folds to " + fmt::format("{:.2f}", folds[0].angle) + " degrees in "),
            std::string::npos)
      << folded;
}

TEST(PlcCreases, SummaryCountsAndMeasures) {
  const PlcSummary s = summarize(build(testing::wedge(40, 2)));
  EXPECT_EQ(s.vertices, 6U);
  EXPECT_EQ(s.curves, 9U);
  EXPECT_EQ(s.straight_curves, 9U);
  EXPECT_EQ(s.patches, 5U);
  EXPECT_EQ(s.planar_patches, 5U);
  EXPECT_EQ(s.regions, 1U);
  EXPECT_NEAR(s.smallest_angle, 40, 1e-9);
  EXPECT_NEAR(s.shortest_segment, 2 * std::sin(20 * pi / 180), 1e-12);
  EXPECT_NEAR(s.spread, s.diagonal / s.shortest_segment, 1e-9);
  EXPECT_FALSE(s.creases.empty());
}

TEST(FoldAngle, OfFlatFansIsNeverAcute) {
  const auto fan = [](double total, int n) {
    std::vector<Vector> rays;
    for (int i = 0; i <= n; ++i)
      rays.push_back({std::cos(total * i / n * pi / 180), std::sin(total * i / n * pi / 180), 0});
    return rays;
  };
  for (const double total : {10.0, 90.0, 170.0, 180.0, 181.0, 270.0, 350.0})
    for (const int n : {3, 7, 20})
      EXPECT_GE(plc::fold_angle(fan(total, n), false), 90 - 1e-9) << total << " " << n;
  auto closed = fan(360, 11);
  closed.pop_back();
  EXPECT_NEAR(plc::fold_angle(closed, true), 180, 1e-6);
}

TEST(SectorAngles, AgreeWithSampling) {
  const plc::Sector s{{1, 0, 0}, {0, 1, 0}};
  EXPECT_NEAR(plc::angle_between(Vector{std::sqrt(0.5), 0, std::sqrt(0.5)}, s), 45, 1e-9);
  EXPECT_NEAR(plc::angle_between(Vector{-std::sqrt(0.5), 0, std::sqrt(0.5)}, s), 90, 1e-9);
  EXPECT_NEAR(plc::angle_between(Vector{0, 0, 1}, s), 90, 1e-9);
  const double c = std::cos(0.2), d = std::sin(0.2);
  EXPECT_NEAR(plc::angle_between(s, {{c * std::sqrt(0.5), c * std::sqrt(0.5), d}, {0, 0, 1}}), 0.2 * 180 / pi,
              1e-9);
}

}  // namespace
}  // namespace collarmesh::plc_creases_test
