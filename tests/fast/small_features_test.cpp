// Features of a complex that are far smaller than the target size are collapsed, and nothing else.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "collarmesh/pipeline.h"
#include "collarmesh/plc_builder.h"
#include "collarmesh/repair.h"
#include "support/shapes.h"

namespace collarmesh::small_features_test {
namespace {

constexpr double side = 10;

/// Returns the soup without tags, so that its facets are no groups.
PolygonSoup without_tags(const PolygonSoup& soup) {
  PolygonSoup result;
  result.points = soup.points;
  for (Index f = 0; f < soup.facet_count(); ++f) {
    result.begin_facet();
    for (auto [q, end] = soup.facet_polygons(f); q < end; ++q) result.add_polygon(soup.polygon(q));
  }
  return result;
}

/// A cube of side 10 with a chamfer (tag 5) along one edge.
PolygonSoup chamfered_cube(double chamfer) {
  const std::vector<Point> polygon{
      {0, 0, 0}, {side, 0, 0}, {side, side - chamfer, 0}, {side - chamfer, side, 0}, {0, side, 0}};
  return testing::extrusion(polygon, side);
}

/// A house whose ridge is a needle: a plateau from a point to a width of 0.01 at the other gable.
PolygonSoup house_with_needle() {
  constexpr double half = 0.005, eaves = 5;
  PolygonSoup soup;
  soup.points = {{0, 0, 0},
                 {side, 0, 0},
                 {side, side, 0},
                 {0, side, 0},
                 {0, 0, eaves},
                 {side, 0, eaves},
                 {side, side, eaves},
                 {0, side, eaves},
                 {0, side / 2, side},
                 {side, side / 2 - half, side},
                 {side, side / 2 + half, side}};
  const std::vector<std::vector<Index>> facets{
      {0, 3, 2, 1}, {0, 1, 5, 4}, {2, 3, 7, 6}, {0, 4, 8, 7, 3}, {1, 2, 6, 10, 9, 5},
      {4, 5, 9},    {4, 9, 8},    {6, 7, 10},   {7, 8, 10},      {8, 9, 10}};
  for (const std::vector<Index>& facet : facets) soup.add_facet(facet);
  return soup;
}

RepairOptions to_the_size() {
  RepairOptions options;
  options.target_size = 0;
  return options;
}

RepairedPlc collapsed(const PolygonSoup& soup, const RepairOptions& options = to_the_size()) {
  return collapse_small_features({build_plc({&soup, 1}), {}, {}}, {&soup, 1}, {}, options);
}

void expect_unchanged(const RepairedPlc& complex, const PolygonSoup& soup) {
  const Plc plain = build_plc({&soup, 1});
  EXPECT_FALSE(complex.report.repaired);
  EXPECT_TRUE(complex.report.small_features.empty());
  EXPECT_EQ(complex.plc.points, plain.points);
  EXPECT_EQ(complex.plc.patches.size(), plain.patches.size());
}

TEST(SmallFeatures, NarrowPatchBecomesACurve) {
  for (const double chamfer : {5e-3, 1e-3, 1e-4}) {
    const RepairedPlc complex = collapsed(without_tags(chamfered_cube(chamfer)));
    EXPECT_EQ(complex.plc.patches.size(), 6U) << chamfer;
    EXPECT_EQ(complex.plc.curves.size(), 12U) << chamfer;
    EXPECT_EQ(complex.plc.vertices.size(), 8U) << chamfer;
    ASSERT_EQ(complex.plc.regions.size(), 2U);
    EXPECT_NEAR(complex.plc.regions[1].volume, side * side * side, side * side * chamfer);
    EXPECT_LE(complex.report.largest_distance_of_input, 2 * chamfer);
    const auto patch = std::ranges::find_if(complex.report.small_features, [](const SmallFeature& f) {
      return f.kind == SmallFeature::Kind::patch;
    });
    ASSERT_NE(patch, complex.report.small_features.end());
    EXPECT_NEAR(patch->size, std::sqrt(2.0) * chamfer, 1e-2 * chamfer);
    EXPECT_NEAR(patch->where.x, side, chamfer);
    EXPECT_NEAR(patch->where.y, side, chamfer);
    EXPECT_EQ(complex.report.small_features.size(), 3U);  // the patch and its two short curves
  }
}

// The fin's rim is far narrower than the feature size, but lies between sides that face opposite ways.
TEST(SmallFeatures, FinsKeepTheirThickness) {
  constexpr double half = 2.5e-3, middle = side / 2, height = 15;
  const std::vector<Point> polygon{{0, 0, 0},
                                   {side, 0, 0},
                                   {side, side, 0},
                                   {middle + half, side, 0},
                                   {middle + half, height, 0},
                                   {middle - half, height, 0},
                                   {middle - half, side, 0},
                                   {0, side, 0}};
  const PolygonSoup soup = without_tags(testing::extrusion(polygon, side));
  const RepairedPlc complex = collapsed(soup);
  EXPECT_NEAR(complex.plc.regions[1].volume, build_plc({&soup, 1}).regions[1].volume, 1e-9);
  EXPECT_EQ(complex.plc.patches.size(), 10U);
}

TEST(SmallFeatures, PatchesAboveTheSizeStay) {
  const PolygonSoup soup = without_tags(chamfered_cube(0.02));
  expect_unchanged(collapsed(soup), soup);
  const PolygonSoup narrow = without_tags(chamfered_cube(1e-3));
  RepairOptions none = to_the_size();
  none.feature_size = 0;
  expect_unchanged(collapsed(narrow, none), narrow);
  expect_unchanged(collapsed(narrow, {}), narrow);  // the target size is not known
  RepairOptions off = to_the_size();
  off.mode = RepairMode::off;
  expect_unchanged(collapsed(narrow, off), narrow);
}

TEST(SmallFeatures, GroupsStay) {
  const PolygonSoup soup = chamfered_cube(1e-3);
  expect_unchanged(collapsed(soup), soup);
}

TEST(SmallFeatures, FeaturesWithASizeStay) {
  const PolygonSoup soup = without_tags(chamfered_cube(1e-3));
  const Plc plc = build_plc({&soup, 1});
  RepairOptions options = to_the_size();
  for (const Plc::Patch& patch : plc.patches)
    if (plc.points[plc.triangles[patch.first_triangle].points[0]].x > side / 2 && patch.normal.x > 0.1 &&
        patch.normal.y > 0.1)
      options.kept_patches.push_back(patch.tag);
  ASSERT_EQ(options.kept_patches.size(), 1U);
  expect_unchanged(collapsed(soup, options), soup);
}

TEST(SmallFeatures, ThinRegionsStay) {
  const std::vector<PolygonSoup> soups{without_tags(testing::box({0, 0, 0}, {side, side, side})),
                                       without_tags(testing::box({0, 0, side}, {side, side, side + 2e-3}))};
  const RepairedPlc complex = collapse_small_features({build_plc(soups), {}, {}}, soups, {}, to_the_size());
  EXPECT_FALSE(complex.report.repaired);
  EXPECT_EQ(complex.plc.regions.size(), 3U);
  EXPECT_EQ(complex.plc.patches.size(), build_plc(soups).patches.size());
}

TEST(SmallFeatures, TipsAreBlunted) {
  const PolygonSoup soup = house_with_needle();
  const Plc before = build_plc({&soup, 1});
  ASSERT_LT(summarize(before).smallest_angle, 0.1);
  const RepairedPlc complex = collapsed(soup);
  EXPECT_GT(summarize(complex.plc).smallest_angle, 0.5);
  ASSERT_EQ(complex.plc.regions.size(), 2U);
  EXPECT_NEAR(complex.plc.regions[1].volume, before.regions[1].volume, 0.1);
  const auto& found = complex.report.small_features;
  ASSERT_FALSE(found.empty());
  EXPECT_EQ(found.front().kind, SmallFeature::Kind::tip);
  EXPECT_EQ(found.front().where, (Point{0, side / 2, side}));
}

TEST(SmallFeatures, NumbersStay) {
  const PolygonSoup soup = without_tags(chamfered_cube(1e-3));
  const Plc before = build_plc({&soup, 1});
  const Plc after = collapsed(soup).plc;
  for (const Plc::Patch& patch : after.patches) {
    const auto same =
        std::ranges::find_if(before.patches, [&](const Plc::Patch& other) { return other.tag == patch.tag; });
    ASSERT_NE(same, before.patches.end());
    EXPECT_NEAR(dot(same->normal, patch.normal), 1, 1e-6);
  }
}

// A chamfer costs no tetrahedra if it is far narrower than the size, however narrow it is.
TEST(SmallFeatures, CostNothing) {
  PipelineOptions options;
  options.mesh.threads = 1;
  const std::size_t plain =
      run_pipeline({std::vector{without_tags(testing::box({0, 0, 0}, {side, side, side}))}}, options)
          .result.mesh.tets.size();
  for (const double chamfer : {5e-3, 1e-3}) {
    const SoupPipelineResult run =
        run_pipeline({std::vector{without_tags(chamfered_cube(chamfer))}}, options);
    EXPECT_TRUE(run.guarantees_hold());
    EXPECT_LE(run.result.mesh.tets.size(), plain + plain / 10) << chamfer;
    EXPECT_FALSE(run.repair.small_features.empty());
  }
}

}  // namespace
}  // namespace collarmesh::small_features_test
