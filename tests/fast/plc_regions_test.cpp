#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <numbers>
#include <string>

#include "collarmesh/plc_builder.h"
#include "support/plc_shapes.h"

namespace collarmesh::plc_regions_test {
namespace {

using testing::findings;
using testing::joined;
using testing::polygonal_box;
using testing::reversed;

Plc build(const std::vector<PolygonSoup>& soups, const PlcOptions& options = {}) {
  Plc plc = build_plc(soups, options);
  EXPECT_EQ(findings(plc), std::vector<std::string>{});
  return plc;
}

std::vector<double> volumes(const Plc& plc) {
  std::vector<double> result;
  for (std::size_t r = 1; r < plc.regions.size(); ++r) result.push_back(plc.regions[r].volume);
  return result;
}

void expect_volumes(const Plc& plc, const std::vector<double>& expected) {
  const auto actual = volumes(plc);
  ASSERT_EQ(actual.size(), expected.size());
  for (std::size_t i = 0; i < actual.size(); ++i) EXPECT_NEAR(actual[i], expected[i], 1e-12 * expected[i]);
}

TEST(PlcRegions, TwoBoxesInTwoSoupsShareTheirFace) {
  const Plc plc = build({polygonal_box({0, 0, 0}, {1, 1, 1}), polygonal_box({1, 0, 0}, {3, 1, 1})});
  expect_volumes(plc, {1, 2});
  EXPECT_EQ(plc.patches.size(), 11U);
  EXPECT_EQ(std::count_if(plc.patches.begin(), plc.patches.end(),
                          [](const auto& p) {
                            return p.regions == std::array<Index, 2>{1, 2};
                          }),
            1);
}

TEST(PlcRegions, InterfaceWithDifferentTriangles) {
  const Plc plc =
      build({testing::subdivided_box({0, 0, 0}, {1, 1, 1}, 1), polygonal_box({1, 0, 0}, {3, 1, 1}),
             testing::shuffled(testing::subdivided_box({0, 0, 1}, {1, 1, 4}, 1), 5, false)});
  expect_volumes(plc, {1, 2, 3});
  EXPECT_EQ(plc.patches.size(), 16U);
}

TEST(PlcRegions, InterfaceOfOtherDiagonal) {
  PolygonSoup first = polygonal_box({0, 0, 0}, {1, 1, 1});
  PolygonSoup second;
  second.points = polygonal_box({1, 0, 0}, {2, 1, 1}).points;
  for (const auto& t : {std::array<Index, 3>{0, 2, 3},
                        {0, 3, 1},
                        {4, 5, 7},
                        {4, 7, 6},
                        {0, 1, 5},
                        {0, 5, 4},
                        {2, 6, 7},
                        {2, 7, 3},
                        {0, 4, 6},
                        {0, 6, 2},
                        {1, 3, 7},
                        {1, 7, 5}})
    second.add_facet(t);
  expect_volumes(build({first, second}), {1, 1});
  std::swap(first, second);
  expect_volumes(build({first, second}), {1, 1});
  // The mirrored diagonal.
  PolygonSoup third;
  third.points = second.points;
  for (const auto& t : {std::array<Index, 3>{0, 2, 1},
                        {2, 3, 1},
                        {4, 5, 6},
                        {5, 7, 6},
                        {0, 1, 4},
                        {1, 5, 4},
                        {2, 6, 3},
                        {6, 7, 3},
                        {0, 4, 2},
                        {4, 6, 2},
                        {1, 3, 5},
                        {3, 7, 5}})
    third.add_facet(t);
  expect_volumes(build({third, first}), {1, 1});
}

TEST(PlcRegions, NestedInwardShellIsACavity) {
  expect_volumes(
      build({joined({polygonal_box({0, 0, 0}, {3, 3, 3}), reversed(polygonal_box({1, 1, 1}, {2, 2, 2}))})}),
      {26});
}

TEST(PlcRegions, NestedOutwardShellIsARegion) {
  expect_volumes(build({joined({polygonal_box({0, 0, 0}, {3, 3, 3}), polygonal_box({1, 1, 1}, {2, 2, 2})})}),
                 {26, 1});
  expect_volumes(build({polygonal_box({1, 1, 1}, {2, 2, 2}), polygonal_box({0, 0, 0}, {3, 3, 3})}), {1, 26});
}

TEST(PlcRegions, SolidInACavity) {
  const Plc plc =
      build({joined({polygonal_box({0, 0, 0}, {5, 5, 5}), reversed(polygonal_box({1, 1, 1}, {4, 4, 4})),
                     polygonal_box({2, 2, 2}, {3, 3, 3})})});
  expect_volumes(plc, {125 - 27, 1});
}

TEST(PlcRegions, InsertFillsACavityExactly) {
  const PolygonSoup block =
      joined({polygonal_box({0, 0, 0}, {3, 3, 3}), reversed(polygonal_box({1, 1, 1}, {2, 2, 2}))});
  expect_volumes(build({block, polygonal_box({1, 1, 1}, {2, 2, 2})}), {26, 1});
}

TEST(PlcRegions, CavityThatTouchesTheWallInAnEdge) {
  // The cavity's edge lies on an edge of the box: a non-manifold edge.
  PolygonSoup soup;
  soup.points = {{0, 0, 0},     {2, 0, 0},     {2, 2, 0},   {0, 2, 0},     {0, 0, 2},
                 {2, 0, 2},     {2, 2, 2},     {0, 2, 2},   {0.5, 1, 0.5}, {0.5, 1, 1.5},
                 {1.5, 1, 0.5}, {1.5, 1, 1.5}, {1, 0, 0.5}, {1, 0, 1.5}};
  const auto facet = [&](std::vector<Index> corners) { soup.add_facet(corners); };
  facet({0, 3, 2, 1});
  facet({4, 5, 6, 7});
  facet({1, 2, 6, 5});
  facet({3, 7, 6, 2});
  facet({0, 4, 7, 3});
  // The front wall y = 0 with the segment 12-13 as a slit.
  facet({0, 1, 12});
  facet({1, 5, 13, 12});
  facet({5, 4, 13});
  facet({4, 0, 12, 13});
  // A triangular prism behind it, with normals inwards (away from the solid).
  facet({10, 8, 12});
  facet({9, 11, 13});
  facet({8, 9, 13, 12});
  facet({10, 11, 9, 8});
  facet({12, 13, 11, 10});
  const double cavity = 0.5;
  expect_volumes(build({soup}), {8 - cavity});
}

TEST(PlcRegions, InwardShellAloneIsASolid) {
  const Plc plc = build({reversed(polygonal_box({0, 0, 0}, {1, 1, 1}))});
  expect_volumes(plc, {1});
  for (const auto& patch : plc.patches) EXPECT_EQ(patch.regions, (std::array<Index, 2>{1, 0}));
}

TEST(PlcRegions, MixedUpOrientationGoesByNesting) {
  const PolygonSoup soup = joined({testing::shuffled(polygonal_box({0, 0, 0}, {5, 5, 5}), 1, true),
                                   testing::shuffled(polygonal_box({1, 1, 1}, {4, 4, 4}), 2, true),
                                   testing::shuffled(polygonal_box({2, 2, 2}, {3, 3, 3}), 4, true)});
  expect_volumes(build({soup}), {125 - 27, 1});
}

TEST(PlcRegions, BoxesThatTouchInAnEdge) {
  expect_volumes(build({joined({polygonal_box({0, 0, 0}, {1, 1, 1}), polygonal_box({1, 1, 0}, {2, 2, 1})})}),
                 {1, 1});
}

TEST(PlcRegions, InternalFacetSeparatesTwoRegions) {
  PolygonSoup soup = polygonal_box({0, 0, 0}, {1, 1, 1});
  soup.add_facet(std::array<Index, 4>{0, 1, 7, 6}, 5);
  const Plc plc = build({soup});
  expect_volumes(plc, {0.5, 0.5});
}

TEST(PlcRegions, DanglingFacetSeparatesNothing) {
  PolygonSoup soup = testing::subdivided_box({0, 0, 0}, {1, 1, 1}, 2);
  const auto point_at = [&](const Point& p) {
    return static_cast<Index>(std::find(soup.points.begin(), soup.points.end(), p) - soup.points.begin());
  };
  const std::array<Index, 3> fin{point_at({0.5, 0.5, 0}), point_at({0.5, 1, 0}),
                                 static_cast<Index>(soup.points.size())};
  soup.points.push_back({0.5, 0.7, 0.6});
  soup.add_facet(fin);
  const Plc plc = build({soup});
  expect_volumes(plc, {1});
  EXPECT_EQ(plc.patches.size(), 7U);
  EXPECT_EQ(plc.patches.back().regions, (std::array<Index, 2>{1, 1}));
}

TEST(PlcRegions, OpenSheetBesideASolid) {
  PolygonSoup sheet;
  sheet.points = {{3, 0, 0}, {4, 0, 0}, {4, 1, 0}};
  sheet.add_facet(std::array<Index, 3>{0, 1, 2});
  const Plc plc = build({polygonal_box({0, 0, 0}, {1, 1, 1}), sheet});
  expect_volumes(plc, {1});
  EXPECT_EQ(plc.patches.back().regions, (std::array<Index, 2>{0, 0}));
}

TEST(PlcRegions, HoleAndRegionPointsDecideForAComplex) {
  PolygonSoup soup = joined({polygonal_box({0, 0, 0}, {5, 5, 5}), polygonal_box({1, 1, 1}, {2, 2, 2}),
                             polygonal_box({3, 3, 3}, {4, 4, 4})});
  soup.name = "parts.poly";
  expect_volumes(build({soup}), {123, 1, 1});
  soup.hole_points = {{1.5, 1.5, 1.5}};
  soup.region_points = {{{3.5, 3.5, 3.5}, 70, 0.25}, {{0.5, 0.5, 0.5}, 60, 0}, {{9, 9, 9}, 50, 0}};
  const Plc plc = build({soup});
  expect_volumes(plc, {123, 1});
  EXPECT_EQ(plc.regions[1].tag, 60);
  EXPECT_EQ(plc.regions[2].tag, 70);
  EXPECT_EQ(plc.regions[2].size, 0.25);
}

TEST(PlcRegions, PointOnAFacetIsAFault) {
  PolygonSoup soup = polygonal_box({0, 0, 0}, {1, 1, 1});
  soup.hole_points = {{0.5, 0.5, 0}};
  EXPECT_THROW(build_plc({&soup, 1}), PlcError);
}

TEST(PlcRegions, ManyNestedShells) {
  std::vector<PolygonSoup> shells;
  double expected = 0;
  for (int i = 1; i <= 20; ++i) {
    const PolygonSoup shell = testing::sphere(3, i, {0.1 * i, 0, 0});
    shells.push_back(i % 2 == 0 ? shell : reversed(shell));
    const PolygonSoup alone[] = {shell};
    expected += (i % 2 == 0 ? 1 : -1) * build_plc(alone).regions[1].volume;
  }
  const Plc plc = build({joined(shells)});
  EXPECT_EQ(plc.regions.size(), 11U);
  double sum = 0;
  for (const double v : volumes(plc)) sum += v;
  EXPECT_NEAR(sum, expected, 1e-9 * expected);
}

TEST(PlcRegions, NamesComeFromTheirSoups) {
  PolygonSoup first = polygonal_box({0, 0, 0}, {1, 1, 1}), second = polygonal_box({2, 0, 0}, {3, 1, 1});
  first.name = "first.off";
  second.name = "second.off";
  const Plc plc = build({first, second});
  EXPECT_EQ(plc.regions[1].name, "first.off");
  EXPECT_EQ(plc.regions[2].name, "second.off");
  EXPECT_EQ(plc.patches.back().file, 1U);
}

// Returns a box whose inside is given by a region point instead of its facets' orientation.
PolygonSoup named_box(const Point& low, const Point& high, const std::string& name) {
  PolygonSoup soup = polygonal_box(low, high);
  soup.name = name;
  soup.region_points.push_back({0.5 * (low + high), static_cast<Tag>(name.size()), 0});
  return soup;
}

// Makes the square from (1, 1) to (2, 2) a part of the facet at z = 0.
PolygonSoup with_square_in_floor(const PolygonSoup& soup) {
  PolygonSoup facets;
  facets.points = soup.points;
  facets.name = soup.name;
  facets.region_points = soup.region_points;
  for (const auto& [x, y] : {std::pair{1, 1}, {2, 1}, {2, 2}, {1, 2}})
    facets.points.push_back({static_cast<double>(x), static_cast<double>(y), 0});
  const auto first = static_cast<Index>(soup.points.size());
  for (Index f = 0; f < soup.facet_count(); ++f) {
    const auto corners = soup.polygon(soup.facet_polygons(f)[0]);
    facets.add_facet(corners);
    if (std::all_of(corners.begin(), corners.end(), [&](Index p) { return soup.points[p].z == 0; }))
      facets.add_polygon(std::array<Index, 4>{first, first + 1, first + 2, first + 3});
  }
  return facets;
}

std::vector<std::string> names(const Plc& plc) {
  std::vector<std::string> result;
  for (std::size_t r = 1; r < plc.regions.size(); ++r)
    result.push_back(fmt::format("{} {}", plc.regions[r].name, plc.regions[r].tag));
  return result;
}

TEST(PlcRegions, ARegionBearsTheNameOfTheFileThatEnclosesIt) {
  const std::vector<PolygonSoup> row{named_box({0, 0, 0}, {1, 1, 1}, "a"),
                                     named_box({1, 0, 0}, {2, 1, 1}, "bb"),
                                     named_box({2, 0, 0}, {3, 1, 1}, "ccc")};
  const std::vector<std::string> of_row{"a 1", "bb 2", "ccc 3"};
  std::vector<std::string> expected(3);
  std::array<std::size_t, 3> order{0, 1, 2};
  do {
    std::transform(order.begin(), order.end(), expected.begin(), [&](std::size_t k) { return of_row[k]; });
    EXPECT_EQ(names(build({row[order[0]], row[order[1]], row[order[2]]})), expected);
  } while (std::next_permutation(order.begin(), order.end()));
  // One box inside the other, with a side in common.
  for (const bool swapped : {false, true}) {
    std::vector<PolygonSoup> nested{named_box({0, 0, 0}, {4, 4, 4}, "a"),
                                    named_box({1, 1, 0}, {2, 2, 1}, "bb")};
    nested[0].region_points[0].point = {3, 3, 3};
    nested[0] = with_square_in_floor(nested[0]);
    if (swapped) std::swap(nested[0], nested[1]);
    expected = swapped ? std::vector<std::string>{"bb 2", "a 1"} : std::vector<std::string>{"a 1", "bb 2"};
    EXPECT_EQ(names(build(nested)), expected);
  }
}

void expect_warning(const PolygonSoup& soup, const Point& where, const std::vector<std::string>& told) {
  const Plc plc = build({soup});
  ASSERT_EQ(plc.warnings.size(), 1U);
  EXPECT_EQ(plc.warnings[0].where, where);
  for (const std::string& text : told)
    EXPECT_NE(plc.warnings[0].message.find(text), std::string::npos) << plc.warnings[0].message;
}

TEST(PlcRegions, PointsWithoutEffectAreTold) {
  PolygonSoup soup = named_box({0, 0, 0}, {1, 1, 1}, "a");
  EXPECT_TRUE(build({soup}).warnings.empty());
  soup.hole_points.push_back({5, 0.5, 0.5});
  expect_warning(soup, {5, 0.5, 0.5}, {"a: the hole point (5, 0.5, 0.5)", "outside", "move it"});
  soup.hole_points.clear();
  soup.region_points.push_back({{0.5, 0.5, -2}, 7, 0});
  expect_warning(soup, {0.5, 0.5, -2}, {"a: the region point (0.5, 0.5, -2)", "outside"});
  // A second point with the same data does not contradict the first one.
  soup.region_points[1] = {{0.25, 0.5, 0.5}, 1, 0};
  EXPECT_TRUE(build({soup}).warnings.empty());
}

TEST(PlcRegions, PointsInCavitiesAreTold) {
  PolygonSoup hollow = named_box({0, 0, 0}, {4, 4, 4}, "a");
  const PolygonSoup cavity = reversed(polygonal_box({1, 1, 1}, {3, 3, 3}));
  hollow.region_points.clear();
  PolygonSoup soup = joined({hollow, cavity});
  soup.name = "a";
  PolygonSoup points;
  points.name = "b";
  points.region_points.push_back({{2, 2, 2}, 7, 0});
  const Plc plc = build({soup, points});
  ASSERT_EQ(plc.warnings.size(), 1U);
  EXPECT_NE(plc.warnings[0].message.find("lies in a cavity and has no effect"), std::string::npos)
      << plc.warnings[0].message;
  EXPECT_EQ(plc.warnings[0].where, (Point{2, 2, 2}));
}

TEST(PlcRegions, PointsThatContradictEachOtherAreTold) {
  PolygonSoup soup = named_box({0, 0, 0}, {1, 1, 1}, "a");
  soup.region_points.push_back({{0.25, 0.5, 0.5}, 7, 0.125});
  expect_warning(soup, {0.25, 0.5, 0.5}, {"(tag 7, size 0.125)", "(0.5, 0.5, 0.5) (tag 1)", "Remove one"});
  EXPECT_EQ(names(build({soup})), std::vector<std::string>{"a 7"});
  soup.region_points.pop_back();
  soup.hole_points.push_back({0.25, 0.5, 0.5});
  PlcOptions options;
  options.require_solid = false;
  const Plc plc = build({soup}, options);
  EXPECT_EQ(plc.regions.size(), 1U);
  ASSERT_EQ(plc.warnings.size(), 1U);
  for (const char* told : {"region point (0.5, 0.5, 0.5)", "hole point (0.25, 0.5, 0.5)", "remove one"})
    EXPECT_NE(plc.warnings[0].message.find(told), std::string::npos) << plc.warnings[0].message;
  try {
    build({soup});
    FAIL();
  } catch (const PlcError& error) {
    EXPECT_NE(std::string(error.what()).find("hole points mark the space inside as empty"), std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace collarmesh::plc_regions_test
