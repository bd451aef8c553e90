// The distances between a repaired surface and its input.
#include "repair/distances.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "support/repair_shapes.h"
#include "support/shapes.h"

namespace collarmesh::repairing::repair_distances_test {
namespace {

using namespace testing::faulty;

std::vector<CornerPoints> triangles_of(const PolygonSoup& soup) {
  const PolygonSoup flat = triangulated(soup);
  std::vector<CornerPoints> triangles;
  triangles.reserve(flat.facet_count());
  for (Index f = 0; f < flat.facet_count(); ++f) {
    const auto c = flat.polygon(f);
    triangles.push_back({flat.points[c[0]], flat.points[c[1]], flat.points[c[2]]});
  }
  return triangles;
}

RepairDistances between(const PolygonSoup& input, const PolygonSoup& repaired) {
  return measure_distances(triangles_of(input), triangles_of(repaired), {});
}

Point random_point(const CornerPoints& t, Random& random) {
  double a = uniform(random, 0, 1), b = uniform(random, 0, 1);
  if (a + b > 1) a = 1 - a, b = 1 - b;
  return t[0] + a * (t[1] - t[0]) + b * (t[2] - t[0]);
}

// Returns an upper bound: the distance to the nearest of many points of each triangle.
double distance_to(const Point& p, const std::vector<CornerPoints>& triangles) {
  constexpr int n = 40;
  double least = INFINITY;
  for (const CornerPoints& t : triangles)
    for (int i = 0; i <= n; ++i)
      for (int j = 0; i + j <= n; ++j)
        least = std::min(
            least, distance(p, t[0] + (i / double{n}) * (t[1] - t[0]) + (j / double{n}) * (t[2] - t[0])));
  return least;
}

TEST(RepairDistances, OfASurfaceToItselfAreZero) {
  const PolygonSoup ball = testing::icosphere(1, 5);
  const RepairDistances same = between(ball, ball), permuted = between(ball, testing::permuted(ball, 3));
  EXPECT_EQ(same.of_repaired, 0);
  EXPECT_EQ(same.of_input, 0);
  EXPECT_EQ(permuted.of_repaired, 0);
  EXPECT_EQ(permuted.of_input, 0);
}

TEST(RepairDistances, ABoxAboveASheet) {
  PolygonSoup sheet;
  sheet.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  sheet.add_facet(std::array<Index, 4>{0, 1, 2, 3}, 1);
  const RepairDistances above = between(sheet, testing::box({0, 0, 0.25}, {1, 1, 1.5}));
  EXPECT_NEAR(above.of_repaired, 1.5, 1e-12);
  EXPECT_NEAR(above.of_input, 0.25, 1e-12);
  // A sheet inside the box does not count.
  const RepairDistances around = between(sheet, testing::box({-1, -1, -0.5}, {2, 2, 0.5}));
  EXPECT_NEAR(around.of_repaired, std::sqrt(2 + 0.25), 1e-12);
  EXPECT_EQ(around.of_input, 0);
}

TEST(RepairDistances, FilledHolesDoNotCountButAreThere) {
  const PolygonSoup cube = testing::box();
  const auto side = [&](bool top) {
    return triangles_of(filtered(cube, [&](Index f) { return (cube.facet_tag(f) == 6) == top; }));
  };
  const RepairDistances d = measure_distances(side(false), side(false), side(true));
  EXPECT_EQ(d.of_repaired, 0);
  EXPECT_EQ(d.of_input, 0);
  // If the filled hole is passed as part of the repaired surface, it counts: the side's centre is 1/2 from
  // the other triangles.
  const RepairDistances whole = measure_distances(side(false), triangles_of(cube), {});
  EXPECT_NEAR(whole.of_repaired, 0.5, 0.02);
}

// Compares with distances at random points and sums of solid angles; the code uses a lattice and hierarchies.
TEST(RepairDistances, AreThoseOfRandomPoints) {
  Random random(31);
  for (unsigned member = 0; member < members(4); ++member) {
    SCOPED_TRACE(member);
    const PolygonSoup input = testing::icosphere(1, 2);
    const PolygonSoup repaired = testing::translated(testing::scaled(input, uniform(random, 0.7, 1.2)),
                                                     uniform(random, 0.1, 0.5) * random_direction(random));
    const auto a = triangles_of(input), b = triangles_of(repaired);
    const RepairDistances d = between(input, repaired);
    double of_repaired = 0, of_input = 0;
    for (int i = 0; i < 400; ++i) {
      of_repaired = std::max(of_repaired, distance_to(random_point(b[random() % b.size()], random), a));
      const Point p = random_point(a[random() % a.size()], random);
      if (direct_winding_number(repaired, p) < 0.5) of_input = std::max(of_input, distance_to(p, b));
    }
    // Some of 400 random points are near the farthest place, so the sampled distance is only slightly too
    // small.
    EXPECT_NEAR(d.of_repaired, of_repaired, 0.06);
    EXPECT_NEAR(d.of_input, of_input, 0.06);
    EXPECT_GT(d.of_repaired, of_repaired - 0.02);
    EXPECT_GT(d.of_input, of_input - 0.02);
  }
}

// A whole repair: parts thinner than the tolerance vanish, and the report says so.
TEST(RepairDistances, OfAFinThatVanishes) {
  const PolygonSoup finned = finned_box(1e-7);
  const RepairedPlc r = build_repaired_plc({&finned, 1});
  ASSERT_TRUE(r.report.repaired);
  EXPECT_LT(r.report.largest_distance, r.report.tolerance);
  EXPECT_NEAR(r.report.largest_distance_of_input, 0.5, 1e-6);
  const auto lines = describe(r.report);
  EXPECT_NE(lines.back().find(
                "within 0.5 of the repaired surface; the farthest part of the input that is gone is at"),
            std::string::npos)
      << lines.back();
  EXPECT_NEAR(std::fabs(distance_to(r.report.farthest_of_input, triangles_of(testing::box()))), 0.5, 0.02);
}

TEST(RepairReport, TellsTheShareOfSheetsThatWereRemoved) {
  const PolygonSoup soup = box_with_wall(0.5, 0.5, 0.25);  // an area of 0.625 of the wall is outside
  const RepairReport report = build_repaired_plc({&soup, 1}).report;
  EXPECT_NEAR(report.dropped.size, 0.625 / 7.125, 1e-9);
  ASSERT_FALSE(report.dropped.where.empty());
  EXPECT_TRUE(std::ranges::any_of(describe(report), [](const std::string& line) {
    return line.find("outside of all solids removed, 8.8% of the area, the first at") != std::string::npos;
  })) << fmt::format("{}", fmt::join(describe(report), "\n"));
}

TEST(RepairReport, HasALineForEachKindOfChange) {
  EXPECT_TRUE(describe({}).empty());
  const auto places = [](std::size_t count) { return RepairPlaces{count, 0.25, {{7, 8, 9}}}; };
  const auto line_of = [](const RepairReport& report) {
    const std::vector<std::string> lines = describe(report);
    EXPECT_EQ(lines.size(), 1U);
    return lines.empty() ? std::string() : lines.front();
  };
  struct Kind {
    RepairPlaces RepairReport::*places;
    std::string one, many;
    bool has_size;
  };
  const std::vector<Kind> kinds{
      {&RepairReport::repeated, "1 repeated facet dropped", "3 repeated facets dropped", false},
      {&RepairReport::turned, "1 inside-out closed surface turned", "3 inside-out closed surfaces turned",
       false},
      {&RepairReport::stitched, "1 place stitched", "3 places stitched", true},
      {&RepairReport::collapsed, "1 feature below the tolerance of 0.5", "3 features below", true},
      {&RepairReport::cut, "1 pair of intersecting facets cut", "3 pairs of intersecting", false},
      {&RepairReport::kept, "1 place left as before", "3 places left as before", false},
      {&RepairReport::flakes, "1 closed part thinner than the tolerance of 0.5", "3 closed parts", true},
      {&RepairReport::merged, "1 triangle removed that lay inside", "3 triangles removed that", true},
      {&RepairReport::dropped, "1 triangle of sheets", "3 triangles of sheets", false},
      {&RepairReport::thin_chambers, "around it,", "around them,", true},
      {&RepairReport::vanished, "keeps it", "keeps them", true},
      {&RepairReport::united, "1 region fewer than before", "3 regions fewer than before", false}};
  for (const Kind& kind : kinds)
    for (const std::size_t count : {1U, 3U}) {
      RepairReport report;
      report.tolerance = 0.5;
      report.*kind.places = places(count);
      const std::string line = line_of(report);
      EXPECT_NE(line.find(count == 1 ? kind.one : kind.many), std::string::npos) << line;
      EXPECT_NE(line.find(", the first at (7, 8, 9)"), std::string::npos) << line;
      EXPECT_EQ(line.find("0.25") != std::string::npos, kind.has_size) << line;
      (report.*kind.places).where.clear();
      EXPECT_EQ(line_of(report).find("the first at"), std::string::npos);
    }
  for (const auto& [count, says] : {std::pair{std::size_t{1}, "1 polygon cut into triangles, because it was"},
                                    {std::size_t{2}, "2 polygons cut into triangles, because they were"}}) {
    RepairReport report;
    report.split_polygons = count;
    EXPECT_TRUE(line_of(report).starts_with(says)) << line_of(report);
  }
  RepairReport dropped, second;
  dropped.dropped_polygons = 2;
  EXPECT_EQ(line_of(dropped), "2 polygons without an area dropped");
  second.second_sides = 4;
  EXPECT_TRUE(line_of(second).starts_with("4 triangles dropped that coincided")) << line_of(second);
}

TEST(RepairReport, ListsSmallFeaturesAndLostTags) {
  RepairReport report;
  report.feature_size = 0.5;
  report.lost_tags = {4, 9};
  report.filled.push_back({.tag = 3, .edges = 5, .area = 2.5, .where = {1, 2, 3}});
  using Kind = SmallFeature::Kind;
  for (const Kind kind : {Kind::curve, Kind::patch, Kind::tip})
    report.small_features.push_back({kind, 0.125, kind == Kind::tip ? 0 : 6, {1, 2, 3}});
  for (int more = 0; more < 9; ++more) report.small_features.push_back({Kind::curve, 0.25, 8, {4, 5, 6}});
  std::vector<std::string> lines = describe(report);
  ASSERT_EQ(lines.size(), 3U);
  EXPECT_EQ(lines[0], "a hole of 5 edges around (1, 2, 3) filled with an area of 2.5, tag 3");
  EXPECT_TRUE(
      lines[1].starts_with("12 features smaller than the feature size of 0.5 collapsed: curve (tag 6) of "
                           "size 0.125 at (1, 2, 3), patch (tag 6) of size 0.125 at (1, 2, 3), tip of "
                           "size 0.125 at (1, 2, 3), curve (tag 8)"))
      << lines[1];
  EXPECT_NE(lines[1].find("... and 2 more"), std::string::npos) << lines[1];
  EXPECT_EQ(lines[2], "nothing is left of the facets with tags 4, 9");
  report = {};
  report.repaired = true;
  EXPECT_EQ(describe(report), std::vector<std::string>{"repair moved nothing"});
  report.tolerance = 0.5;
  report.largest_distance = 0.25;
  report.largest_distance_of_input = 2;
  report.farthest_of_input = {1, 2, 3};
  lines = describe(report);
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_TRUE(
      lines[0].ends_with("within 2 of the repaired surface; the farthest part of the input that is gone "
                         "is at (1, 2, 3)"))
      << lines[0];
  report.wrapped = true;
  EXPECT_EQ(describe(report),
            std::vector<std::string>{"a closed surface was wrapped around everything; it keeps "
                                     "within 0.25 of the input"});
}

// kept_volume

KeptVolume kept_of(const PolygonSoup& input, const PolygonSoup& repaired) {
  return kept_volume(triangles_of(input), triangles_of(repaired));
}

TEST(KeptVolume, OfABoxInTwoHalves) {
  const PolygonSoup box = testing::box({0, 0, 0}, {2, 1, 1});
  const KeptVolume all = kept_of(box, box), half = kept_of(box, testing::box());
  EXPECT_NEAR(all.input, 2, 0.02);
  EXPECT_EQ(all.lost, 0);
  EXPECT_NEAR(half.input, 2, 0.02);
  EXPECT_NEAR(half.lost, 1, 0.02);
  EXPECT_GT(half.where.x, 1);
}

TEST(KeptVolume, DoesNotDependOnTheOrientation) {
  const PolygonSoup ball = testing::icosphere(1, 6);
  const KeptVolume kept = kept_of(testing::inverted(ball), ball);
  EXPECT_NEAR(kept.input, 4.1, 0.3);
  EXPECT_EQ(kept.lost, 0);
}

// An open surface encloses no volume that could be lost.
TEST(KeptVolume, OfHalfABoxIsNotKnown) {
  const PolygonSoup cube = testing::box();
  const PolygonSoup half = filtered(cube, [&](Index f) { return cube.facet_tag(f) <= 3; });
  EXPECT_EQ(kept_of(half, testing::box({5, 5, 5}, {6, 6, 6})).input, 0);
}

// Regions of valid complexes that a repair removes

PolygonSoup layered_block(double thickness) {
  PolygonSoup soup;
  for (const double z : {0.0, 0.5, 0.5 + thickness, 1.0})
    for (const auto& [x, y] : {std::pair{0.0, 0.0}, {1.0, 0.0}, {1.0, 1.0}, {0.0, 1.0}})
      soup.points.push_back({x, y, z});
  Tag tag = 0;
  for (Index k = 0; k < 4; ++k) soup.add_facet(std::array{4 * k, 4 * k + 1, 4 * k + 2, 4 * k + 3}, ++tag);
  for (Index k = 0; k < 3; ++k)
    for (Index c = 0; c < 4; ++c) {
      const Index next = (c + 1) % 4;
      soup.add_facet(std::array{4 * k + c, 4 * k + next, 4 * k + 4 + next, 4 * k + 4 + c}, ++tag);
    }
  return soup;
}

TEST(LostRegions, AThinLayerIsTold) {
  for (const double thickness : {1e-3, 1e-6}) {
    SCOPED_TRACE(thickness);
    const PolygonSoup block = layered_block(thickness);
    const RepairedPlc r = build_repaired_plc({&block, 1});
    const bool vanishes = thickness < 1e-5;
    // The two sides of the thin layer cancel, so the regions below and above it become one.
    EXPECT_EQ(r.plc.regions.size(), vanishes ? 2U : 4U);
    EXPECT_EQ(r.report.vanished.count, vanishes ? 1U : 0U);
    EXPECT_EQ(r.report.united.count, vanishes ? 1U : 0U);
    if (!vanishes) continue;
    EXPECT_NEAR(r.report.vanished.size, thickness, 1e-3 * thickness);
    EXPECT_NEAR(r.report.vanished.where.front().z, 0.5, 2 * thickness);
    const auto lines = describe(r.report);
    EXPECT_TRUE(std::ranges::any_of(lines, [](const std::string& line) {
      return line.starts_with("1 region as thin as the tolerance") &&
             line.find("--repair-tolerance") != std::string::npos;
    })) << lines.front();
  }
}

TEST(LostRegions, BoxesThatAreOneNowAreTold) {
  const PolygonSoup boxes[] = {
      testing::joined(testing::box(), testing::translated(testing::box(), {0, 0, 1 + 1e-6}))};
  const RepairedPlc r = build_repaired_plc(boxes);
  ASSERT_EQ(r.plc.regions.size(), 2U);
  EXPECT_EQ(r.report.united.count, 1U);
  EXPECT_EQ(r.report.vanished.count, 0U);
}

}  // namespace
}  // namespace collarmesh::repairing::repair_distances_test
