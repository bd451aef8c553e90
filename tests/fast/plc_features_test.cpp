#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "collarmesh/plc_builder.h"
#include "support/plc_shapes.h"

namespace collarmesh::plc_features_test {
namespace {

using testing::findings;

Plc build(const PolygonSoup& soup, const PlcOptions& options = {}) {
  Plc plc = build_plc({&soup, 1}, options);
  EXPECT_EQ(findings(plc), std::vector<std::string>{});
  return plc;
}

TEST(PlcFeatures, BoxOfQuadrangles) {
  const Plc plc = build(testing::polygonal_box({0, 0, 0}, {1, 2, 3}));
  EXPECT_EQ(plc.vertices.size(), 8U);
  EXPECT_EQ(plc.curves.size(), 12U);
  EXPECT_EQ(plc.patches.size(), 6U);
  EXPECT_EQ(plc.triangles.size(), 12U);
  ASSERT_EQ(plc.regions.size(), 2U);
  EXPECT_DOUBLE_EQ(plc.regions[1].volume, 6);
  for (const auto& patch : plc.patches) {
    EXPECT_TRUE(patch.planar);
    EXPECT_EQ(patch.regions, (std::array<Index, 2>{1, 0}));
    EXPECT_EQ(patch.curves.size(), 4U);
    EXPECT_EQ(patch.vertices.size(), 4U);
  }
  for (const auto& curve : plc.curves) EXPECT_TRUE(curve.straight);
}

TEST(PlcFeatures, CoplanarTrianglesAndCollinearPointsMerge) {
  for (const double feature_angle : {0.0, 30.0}) {
    PlcOptions options;
    options.feature_angle = feature_angle;
    const Plc plc = build(testing::moved(testing::subdivided_box({0, 0, 0}, {1, 1, 1}, 7), 3, 1, 5), options);
    EXPECT_EQ(plc.vertices.size(), 8U);
    EXPECT_EQ(plc.curves.size(), 12U);
    EXPECT_EQ(plc.patches.size(), 6U);
    for (const auto& curve : plc.curves) EXPECT_EQ(curve.points.size(), 8U);
  }
}

// Triangles of CAD faces may be needles along an edge, which lie within the tolerance in the planes of both
// faces there. Even if the faces meet at an acute angle, a needle is no fold of its own face.
TEST(PlcFeatures, NeedlesAlongEdgesOfGivenFacesMakeNoSegments) {
  constexpr double near = 1e-9;
  PolygonSoup soup;
  soup.given_features = true;
  soup.points = {{0, 0, 0},
                 {2, 0, 0},
                 {0.5, 0.8, 0},
                 {0, 0, 1},
                 {2, 0, 1},
                 {0.5, 0.8, 1},
                 {0.5 * near, 0.8 * near, 0.5}};
  soup.point_tags.assign(soup.points.size(), 0);
  const std::vector<std::pair<std::vector<Index>, Tag>> facets{
      {{0, 2, 1}, 1}, {{3, 4, 5}, 2}, {{0, 1, 4, 3}, 3}, {{1, 2, 5, 4}, 4},
      {{0, 3, 6}, 5}, {{3, 5, 6}, 5}, {{5, 2, 6}, 5},    {{2, 0, 6}, 5}};
  for (const auto& [corners, tag] : facets) soup.add_facet(corners, tag);
  const Plc plc = build(soup);
  EXPECT_EQ(plc.patches.size(), 5U);
  EXPECT_EQ(plc.curves.size(), 9U);
}

TEST(PlcFeatures, PointsOffTheirPlaneWithinTheToleranceMakeNoSegments) {
  PolygonSoup soup = testing::subdivided_box({0, 0, 0}, {1, 1, 1}, 8);
  for (std::size_t i = 0; i < soup.points.size(); ++i)
    soup.points[i] = soup.points[i] + 1e-7 * Point{std::sin(7.0 * i), std::sin(11.0 * i), std::sin(13.0 * i)};
  PlcOptions options;
  options.feature_angle = 0;
  const Plc merged = build(soup, options);
  EXPECT_EQ(merged.patches.size(), 6U);
  EXPECT_EQ(merged.curves.size(), 12U);
  EXPECT_GT(merged.largest_deviation, 1e-8);
  EXPECT_LT(merged.largest_deviation, 2e-6);
  options.planar_tolerance = 0;
  EXPECT_GT(build(soup, options).patches.size(), 600U);
}

TEST(PlcFeatures, NeedlesAlongAnEdgeMakeNoSegments) {
  // A thin strip of triangles along one edge of a box, with an inner border made crooked by rounding.
  PolygonSoup soup = testing::subdivided_box({0, 0, 0}, {1, 1, 1}, 10);
  for (Point& p : soup.points)
    if (p.z == 1 && p.x == 0.1) p = {1e-8, p.y, 1 + 1e-9 * std::sin(100 * p.y)};
  const Plc plc = build(soup, {.feature_angle = 0});
  EXPECT_EQ(plc.patches.size(), 6U);
  EXPECT_EQ(plc.curves.size(), 12U);
}

TEST(PlcFeatures, CylinderOfSmoothSides) {
  const Plc plc = build(testing::polygonal_cylinder(40, 1, 2));
  EXPECT_EQ(plc.patches.size(), 3U);
  EXPECT_EQ(plc.vertices.size(), 0U);
  ASSERT_EQ(plc.curves.size(), 2U);
  for (const auto& curve : plc.curves) {
    EXPECT_TRUE(curve.closed);
    EXPECT_FALSE(curve.straight);
    EXPECT_EQ(curve.points.size(), 40U);
  }
  EXPECT_EQ(std::count_if(plc.patches.begin(), plc.patches.end(), [](const auto& p) { return p.planar; }), 2);
}

TEST(PlcFeatures, CylinderWithFeatureAngleZeroIsAPrism) {
  const Plc plc = build(testing::polygonal_cylinder(40, 1, 2), {.feature_angle = 0});
  EXPECT_EQ(plc.patches.size(), 42U);
  EXPECT_EQ(plc.curves.size(), 120U);
  EXPECT_EQ(plc.vertices.size(), 80U);
}

TEST(PlcFeatures, FeatureAngleZeroCutsAFineCircleWhereItLeavesItsChord) {
  PlcOptions options;
  options.feature_angle = 0;
  options.planar_tolerance = 1e-3;
  const Plc plc = build(testing::polygonal_cylinder(400, 1, 2), options);
  EXPECT_GT(plc.vertices.size(), 20U);
  EXPECT_LT(plc.vertices.size(), 400U);
  for (const auto& curve : plc.curves) {
    EXPECT_TRUE(curve.straight);
    EXPECT_FALSE(curve.closed);
  }
}

TEST(PlcFeatures, TagsSplitAFlatSide) {
  PolygonSoup soup;
  soup.points = {{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}, {1, 0.5, 1}};
  const auto facet = [&](std::vector<Index> corners, Tag tag) { soup.add_facet(corners, tag); };
  facet({0, 3, 5, 4}, 1);
  facet({4, 5, 2, 1}, 2);
  facet({0, 4, 6}, 3);
  facet({4, 1, 6}, 3);
  facet({1, 2, 6}, 3);
  facet({2, 5, 6}, 3);
  facet({5, 3, 6}, 3);
  facet({3, 0, 6}, 3);
  const Plc plc = build(soup);
  EXPECT_EQ(plc.patches.size(), 6U);
  std::vector<Tag> tags;
  for (const auto& patch : plc.patches) tags.push_back(patch.tag);
  EXPECT_EQ(std::count(tags.begin(), tags.end(), 3), 4);
  // The border between the two tags ends in the middle of two sides, where vertices are made.
  EXPECT_EQ(plc.vertices.size(), 7U);
}

TEST(PlcFeatures, NamedSegmentsArePartsOfCurves) {
  PolygonSoup soup = testing::subdivided_box({0, 0, 0}, {1, 1, 1}, 4);
  const auto point_at = [&](const Point& p) {
    return static_cast<Index>(std::find(soup.points.begin(), soup.points.end(), p) - soup.points.begin());
  };
  for (double x : {0.25, 0.5})
    soup.segments.push_back({point_at({x, 0.5, 1}), point_at({x + 0.25, 0.5, 1}), 9});
  const Plc plc = build(soup);
  EXPECT_EQ(plc.patches.size(), 6U);
  EXPECT_EQ(plc.curves.size(), 13U);
  EXPECT_EQ(plc.vertices.size(), 10U);
  const auto named =
      std::find_if(plc.curves.begin(), plc.curves.end(), [](const auto& c) { return c.tag == 9; });
  ASSERT_NE(named, plc.curves.end());
  EXPECT_EQ(named->points.size(), 3U);
  EXPECT_EQ(named->patches.size(), 1U);
}

TEST(PlcFeatures, LooseSegmentsAndPointsInsideARegion) {
  PolygonSoup soup = testing::polygonal_box({0, 0, 0}, {1, 1, 1});
  soup.points.insert(soup.points.end(), {{0.5, 0.5, 0.2}, {0.5, 0.5, 0.8}, {0.2, 0.2, 0.2}});
  soup.point_tags.assign(soup.points.size(), 0);
  soup.point_tags[10] = 4;
  soup.segments.push_back({8, 9, 7});
  soup.add_facet(std::array<Index, 1>{10});
  const Plc plc = build(soup);
  EXPECT_EQ(plc.curves.size(), 13U);
  EXPECT_EQ(plc.curves.back().tag, 7);
  EXPECT_TRUE(plc.curves.back().patches.empty());
  EXPECT_EQ(plc.vertices.size(), 11U);
  EXPECT_EQ(plc.vertices.back().tag, 4);
}

TEST(PlcFeatures, TouchingPointIsAVertex) {
  // Two smooth spheres that share one point.
  const PolygonSoup soup =
      testing::joined({testing::sphere(16, 1, {0, 0, 0}), testing::sphere(16, 1, {2, 0, 0})});
  const Plc plc = build(soup);
  ASSERT_EQ(plc.vertices.size(), 1U);
  EXPECT_EQ(plc.points[plc.vertices[0].point], (Point{1, 0, 0}));
  EXPECT_EQ(plc.vertices[0].patches.size(), 2U);
  EXPECT_EQ(plc.regions.size(), 3U);
}

TEST(PlcFeatures, UnusedPointsOfASurfaceAreDropped) {
  PolygonSoup soup = testing::polygonal_box({0, 0, 0}, {1, 1, 1});
  soup.points.push_back({100, 0, 0});
  EXPECT_EQ(build(soup).vertices.size(), 8U);
  EXPECT_LT(build(soup).bounds.diagonal(), 2);
}

TEST(PlcFeatures, LoopAtOneVertexRepeatsIt) {
  // A drop: a circle with one sharp corner, extruded.
  PolygonSoup soup;
  std::vector<Index> bottom, top;
  const Index n = 40;
  for (Index i = 0; i < n; ++i) {
    const double t = std::numbers::pi * (2.0 * i / n);
    const double r = std::sin(t / 2);
    soup.points.push_back({std::cos(t), r * std::sin(t), 0});
    soup.points.push_back({std::cos(t), r * std::sin(t), 1});
    bottom.push_back(2 * (n - 1 - i));
    top.push_back(2 * i + 1);
  }
  for (Index i = 0; i < n; ++i) {
    const Index j = (i + 1) % n;
    soup.add_facet(std::array<Index, 4>{2 * i, 2 * j, 2 * j + 1, 2 * i + 1});
  }
  soup.add_facet(bottom);
  soup.add_facet(top);
  const Plc plc = build(soup);
  EXPECT_EQ(plc.vertices.size(), 2U);
  ASSERT_EQ(plc.curves.size(), 3U);
  for (const auto& curve : plc.curves) {
    EXPECT_FALSE(curve.closed);
    if (curve.ends[0] == curve.ends[1]) {
      EXPECT_EQ(curve.points.front(), curve.points.back());
      EXPECT_EQ(curve.points.size(), n + 1);
    }
  }
}

// Two flat pyramids on one base: no surface is smooth where it is folded, even if features are given.
TEST(PlcFeatures, FoldsAreCurvesWhereFeaturesAreGiven) {
  PolygonSoup soup;
  soup.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.5, 0.1}, {0.5, 0.5, -0.1}};
  for (Index i = 0; i < 4; ++i) {
    soup.add_facet(std::array<Index, 3>{i, (i + 1) % 4, 4}, 1);
    soup.add_facet(std::array<Index, 3>{(i + 1) % 4, i, 5}, 1);
  }
  soup.given_features = true;
  const Plc plc = build(soup);
  EXPECT_EQ(plc.patches.size(), 2U);
  double length = 0;
  for (const auto& curve : plc.curves)
    for (std::size_t i = 0; i + 1 < curve.points.size(); ++i)
      length += distance(plc.points[curve.points[i]], plc.points[curve.points[i + 1]]);
  EXPECT_DOUBLE_EQ(length, 4);
}

// summarize_patches, summarize_curves

TEST(SummaryByTag, PatchesHaveTheirAreaAndAPlaceOnTheFirst) {
  Plc plc = build(testing::polygonal_box({0, 0, 0}, {1, 2, 3}));
  for (Plc::Patch& patch : plc.patches) {  // sides across x get one tag, all others another
    patch.tag = std::fabs(patch.normal.x) > 0.5 ? 4 : -9;
    patch.planar = patch.normal.z < 0.5;
  }
  plc.names.set(2, 4, "ends");
  const std::vector<PatchSummary> summaries = summarize_patches(plc);
  ASSERT_EQ(summaries.size(), 2U);
  const PatchSummary &rest = summaries[0], &ends = summaries[1];
  EXPECT_EQ(ends.tag, 4);
  EXPECT_EQ(ends.name, "ends");
  EXPECT_EQ(ends.count, 2U);
  EXPECT_TRUE(ends.planar);
  EXPECT_DOUBLE_EQ(ends.area, 12);
  EXPECT_TRUE(ends.where.x == 0 || ends.where.x == 1);
  EXPECT_TRUE(ends.where.y > 0 && ends.where.y < 2 && ends.where.z > 0 && ends.where.z < 3);
  EXPECT_EQ(rest.tag, -9);
  EXPECT_EQ(rest.name, "");
  EXPECT_EQ(rest.count, 4U);
  EXPECT_FALSE(rest.planar) << "one of them is not";
  EXPECT_DOUBLE_EQ(rest.area, 2 * (3 + 2));
}

TEST(SummaryByTag, CurvesHaveTheirLengthAndAPlaceOnTheFirst) {
  Plc plc = build(testing::polygonal_cylinder(24, 1, 3));
  ASSERT_EQ(plc.curves.size(), 2U);
  const double length = 24 * 2 * std::sin(std::numbers::pi / 24);
  for (Plc::Curve& curve : plc.curves) curve.tag = 5;
  plc.names.set(1, 5, "rims");
  const std::vector<CurveSummary> both = summarize_curves(plc);
  ASSERT_EQ(both.size(), 1U);
  EXPECT_EQ(both[0].name, "rims");
  EXPECT_EQ(both[0].count, 2U);
  EXPECT_FALSE(both[0].straight);
  EXPECT_NEAR(both[0].length, 2 * length, 1e-12);
  EXPECT_NEAR(std::hypot(both[0].where.x, both[0].where.y), std::cos(std::numbers::pi / 24), 1e-12);
  EXPECT_EQ(both[0].where.z, plc.points[plc.curves[0].points[0]].z);
  const std::vector<CurveSummary> edges =
      summarize_curves(build(testing::polygonal_box({0, 0, 0}, {1, 2, 3})));
  double sum = 0;
  for (const CurveSummary& each : edges) {
    EXPECT_TRUE(each.straight);
    sum += each.length;
  }
  EXPECT_DOUBLE_EQ(sum, 4 * (1 + 2 + 3));
}

}  // namespace
}  // namespace collarmesh::plc_features_test
