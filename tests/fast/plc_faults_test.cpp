#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "collarmesh/plc_builder.h"
#include "facets/faults.h"
#include "support/plc_shapes.h"

namespace collarmesh::plc_faults_test {
namespace {

using Kind = PlcFault::Kind;

std::optional<PlcError> error_of(const std::vector<PolygonSoup>& soups, const PlcOptions& options = {}) {
  try {
    build_plc(soups, options);
  } catch (const PlcError& error) {
    return error;
  }
  return std::nullopt;
}

void expect_fault(const std::vector<PolygonSoup>& soups, Kind kind, const std::string& part_of_message = {}) {
  const auto error = error_of(soups);
  ASSERT_TRUE(error);
  EXPECT_EQ(error->faults[0].kind, kind) << error->what();
  EXPECT_NE(std::string(error->what()).find(part_of_message), std::string::npos) << error->what();
}

TEST(PlcFaults, PointThatIsNotFinite) {
  PolygonSoup soup = testing::polygonal_box({0, 0, 0}, {1, 1, 1});
  soup.name = "cube.off";
  soup.points[3].y = NAN;
  expect_fault({soup}, Kind::bad_point, "cube.off: point 3");
}

TEST(PlcFaults, CoordinatesOutOfRange) {
  for (const double scale : {1e31, 1e80, 1e150, 1e200, 1e-31, 1e-80, 1e-150})
    expect_fault({testing::polygonal_box({0, 0, 0}, {scale, scale, scale})}, Kind::bad_point, "scale it");
  for (const double scale : {1e29, 1e-29})
    EXPECT_FALSE(error_of({testing::polygonal_box({0, 0, 0}, {scale, scale, scale})}));
}

TEST(PlcFaults, CoordinatesTooCoarseForTheExtent) {
  const double far = 1e14;
  expect_fault({testing::polygonal_box({far, 0, 0}, {far + 1, 1, 1})}, Kind::bad_point,
               "move it towards the origin");
  EXPECT_FALSE(error_of({testing::polygonal_box({1e9, 0, 0}, {1e9 + 1, 1, 1})}));
}

// Kinds that make others meaningless come first.
TEST(PlcFaults, AreSortedByKind) {
  const std::vector<Kind> kinds{
      Kind::bad_point,    Kind::non_planar_polygon, Kind::degenerate_facet, Kind::duplicate_points,
      Kind::intersection, Kind::not_orientable,     Kind::open_boundary,    Kind::empty};
  facets::Faults faults;
  for (auto kind = kinds.rbegin(); kind != kinds.rend(); ++kind)
    for (const char* which : {"first", "second"}) faults.add(*kind, which, {}, {});
  try {
    faults.raise();
    ADD_FAILURE();
  } catch (const PlcError& error) {
    ASSERT_EQ(error.faults.size(), 2 * kinds.size());
    for (std::size_t i = 0; i < error.faults.size(); ++i) {
      EXPECT_EQ(error.faults[i].kind, kinds[i / 2]);
      EXPECT_EQ(error.faults[i].message, i % 2 == 0 ? "first" : "second");
    }
    EXPECT_NE(std::string(error.what()).find("15 other faults found"), std::string::npos) << error.what();
  }
}

TEST(PlcFaults, IndexOutOfRange) {
  PolygonSoup soup = testing::polygonal_box({0, 0, 0}, {1, 1, 1});
  soup.add_facet(std::array<Index, 3>{0, 1, 8});
  expect_fault({soup}, Kind::bad_point, "facet 6 uses point 8");
  soup = testing::polygonal_box({0, 0, 0}, {1, 1, 1});
  soup.segments.push_back({0, 99, 0});
  expect_fault({soup}, Kind::bad_point, "segment 0 uses point 99");
}

TEST(PlcFaults, NothingToMesh) {
  expect_fault({}, Kind::empty);
  expect_fault({PolygonSoup{}}, Kind::empty);
}

TEST(PlcFaults, WarpedPolygon) {
  PolygonSoup soup = testing::polygonal_box({0, 0, 0}, {1, 1, 1});
  soup.points[7].z = 1.01;
  const auto error = error_of({soup});
  ASSERT_TRUE(error);
  EXPECT_EQ(error->faults.size(), 1U);
  EXPECT_EQ(error->faults[0].kind, Kind::non_planar_polygon);
  EXPECT_NE(error->faults[0].message.find("Facet 1"), std::string::npos) << error->what();
}

TEST(PlcFaults, FacetWithoutArea) {
  PolygonSoup soup = testing::polygonal_box({0, 0, 0}, {1, 1, 1});
  soup.points.insert(soup.points.end(), {{2, 0, 0}, {3, 0, 0}, {4, 0, 0}, {5, 0, 0}});
  soup.add_facet(std::array<Index, 4>{8, 9, 10, 11});
  expect_fault({soup}, Kind::degenerate_facet, "Facet 6");
}

TEST(PlcFaults, PolygonWithCrossingEdges) {
  PolygonSoup soup;
  soup.points = {{0, 0, 0}, {3, 3, 0}, {4, 0, 0}, {0, 2, 0}};
  soup.add_facet(std::array<Index, 4>{0, 1, 2, 3});
  expect_fault({soup}, Kind::intersection, "cross each other");
}

TEST(PlcFaults, MoebiusStrip) { expect_fault({testing::moebius_strip(20)}, Kind::not_orientable, "Moebius"); }

TEST(PlcFaults, OpenBox) {
  const auto error = error_of({testing::without_facet(testing::polygonal_box({0, 0, 0}, {1, 1, 1}), 1)});
  ASSERT_TRUE(error);
  EXPECT_EQ(error->faults[0].kind, Kind::open_boundary);
  EXPECT_NE(error->faults[0].message.find("4 border edges"), std::string::npos) << error->what();
  EXPECT_DOUBLE_EQ(error->faults[0].where.z, 1);
  PlcOptions options;
  options.require_solid = false;
  const PolygonSoup open = testing::without_facet(testing::polygonal_box({0, 0, 0}, {1, 1, 1}), 1);
  const Plc plc = build_plc({&open, 1}, options);
  EXPECT_EQ(plc.regions.size(), 1U);
  EXPECT_EQ(plc.patches.size(), 5U);
}

TEST(PlcFaults, CrossingFacets) {
  const auto error = error_of(
      {testing::polygonal_box({0, 0, 0}, {1, 1, 1}), testing::polygonal_box({0.5, 0.4, 0.3}, {2, 2, 2})});
  ASSERT_TRUE(error);
  EXPECT_EQ(error->faults[0].kind, Kind::intersection);
  for (const PlcFault& fault : error->faults) {
    const Point& p = fault.where;
    EXPECT_TRUE(p.x <= 1 && p.y <= 1 && p.z <= 1 && p.x >= 0.5 && p.y >= 0.4 && p.z >= 0.3);
  }
}

TEST(PlcFaults, OverlappingFacets) {
  expect_fault({testing::polygonal_box({0, 0, 0}, {1, 1, 1}),
                testing::polygonal_box({1, 0.25, 0.25}, {2, 0.75, 0.75})},
               Kind::intersection);
}

TEST(PlcFaults, FoldedFacets) {
  PolygonSoup soup = testing::polygonal_box({0, 0, 0}, {1, 1, 1});
  soup.points.insert(soup.points.end(), {{3, 0, 0}, {4, 0, 0}, {3.2, 1, 0}, {3.7, 1, 0}});
  soup.add_facet(std::array<Index, 3>{8, 9, 10});
  soup.add_facet(std::array<Index, 3>{9, 8, 11});
  expect_fault({soup}, Kind::intersection);
}

TEST(PlcFaults, CornerOnAnotherEdge) {
  // The upper side is cut into two facets, its neighbours are not.
  PolygonSoup soup = testing::without_facet(testing::polygonal_box({0, 0, 0}, {1, 1, 1}), 1);
  soup.points.push_back({0.5, 0, 1});
  soup.add_facet(std::array<Index, 3>{4, 8, 6});
  soup.add_facet(std::array<Index, 4>{8, 5, 7, 6});
  expect_fault({soup}, Kind::intersection, "touch without a common corner at (0.5, 0, 1)");
}

TEST(PlcFaults, LooseSegmentThroughAFacet) {
  PolygonSoup soup = testing::polygonal_box({0, 0, 0}, {1, 1, 1});
  soup.points.insert(soup.points.end(), {{0.3, 0.4, -1}, {0.3, 0.4, 0.5}});
  soup.segments.push_back({8, 9, 0});
  expect_fault({soup}, Kind::intersection, "(0.3, 0.4, 0)");
}

TEST(PlcFaults, LooseSegmentsThatCross) {
  PolygonSoup soup = testing::polygonal_box({0, 0, 0}, {1, 1, 1});
  soup.points.insert(soup.points.end(), {{0.2, 0.2, 0.5}, {0.8, 0.8, 0.5}, {0.2, 0.8, 0.5}, {0.8, 0.2, 0.5}});
  soup.segments = {{8, 9, 0}, {10, 11, 0}};
  expect_fault({soup}, Kind::intersection, "segment");
}

TEST(PlcFaults, LooseSegmentAlongAnEdge) {
  PolygonSoup soup = testing::polygonal_box({0, 0, 0}, {1, 1, 1});
  soup.points.push_back({0.5, 0, 0});
  soup.segments.push_back({0, 8, 0});
  expect_fault({soup}, Kind::intersection);
}

TEST(PlcFaults, LoosePointOnAFacet) {
  PolygonSoup soup = testing::polygonal_box({0, 0, 0}, {1, 1, 1});
  soup.points.push_back({0.25, 0.5, 1});
  soup.add_facet(std::array<Index, 1>{8});
  expect_fault({soup}, Kind::intersection, "(0.25, 0.5, 1)");
}

// Two boxes, one standing on a corner or an edge, with a gap below the weld distance (1e-9 of the diagonal).
TEST(PlcFaults, FeaturesThatNearlyTouch) {
  constexpr double gap = 1e-10;
  const PolygonSoup below = testing::polygonal_box({0, 0, 0}, {1, 1, 1});
  const PolygonSoup beside = testing::polygonal_box({1 + gap, 0.3, 0.3}, {2, 0.7, 0.7});
  expect_fault({below, beside}, Kind::intersection, "come within 1e-10");
  PolygonSoup on_a_corner;
  on_a_corner.points = {{0.5, 0.5, 1 + gap}, {0.7, 0.5, 1.5}, {0.4, 0.7, 1.5}, {0.4, 0.3, 1.5}};
  for (const std::array<Index, 3>& side : {std::array<Index, 3>{1, 2, 3}, {0, 2, 1}, {0, 3, 2}, {0, 1, 3}})
    on_a_corner.add_facet(side);
  expect_fault({below, on_a_corner}, Kind::intersection, "come within 1e-10 of each other at (0.5, 0.5, 1");
  // The upper body's lowest edge, along y, passes above an edge of the lower box, along x.
  PolygonSoup on_an_edge;
  on_an_edge.points = {{0.5, 0.8, 1 + gap}, {0.5, 1.4, 1 + gap}, {0.3, 1.1, 1.5}, {0.7, 1.1, 1.5}};
  for (const std::array<Index, 3>& side : {std::array<Index, 3>{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}})
    on_an_edge.add_facet(side);
  expect_fault({below, on_an_edge}, Kind::intersection, "do not meet");
}

TEST(PlcFaults, FeaturesThatAreNearButFartherThanTheWeldDistance) {
  const PolygonSoup below = testing::polygonal_box({0, 0, 0}, {1, 1, 1});
  const std::vector<PolygonSoup> beside{below, testing::polygonal_box({1 + 1e-7, 0.3, 0.3}, {2, 0.7, 0.7})};
  EXPECT_FALSE(error_of(beside));
  PlcOptions options;
  options.weld = 1e-11;
  EXPECT_FALSE(error_of({below, testing::polygonal_box({1 + 1e-10, 0.3, 0.3}, {2, 0.7, 0.7})}, options));
}

TEST(PlcFaults, ManyFaultsAreCountedAndTheFirstListed) {
  PolygonSoup soup;
  for (int i = 0; i < 40; ++i) {
    const auto first = static_cast<Index>(soup.points.size());
    soup.points.insert(soup.points.end(),
                       {{std::cos(i), std::sin(i), 0}, {-std::cos(i), -std::sin(i), 0}, {0, 0.001 * i, 1}});
    soup.add_facet(std::array<Index, 3>{first, first + 1, first + 2});
  }
  const auto error = error_of({soup});
  ASSERT_TRUE(error);
  EXPECT_EQ(error->faults.size(), 50U);
  EXPECT_NE(std::string(error->what()).find("other faults"), std::string::npos) << error->what();
}

TEST(PlcFaults, OptionsOutOfRange) {
  const PolygonSoup soup = testing::polygonal_box({0, 0, 0}, {1, 1, 1});
  PlcOptions options;
  options.feature_angle = -1;
  EXPECT_THROW(build_plc({&soup, 1}, options), OptionError);
  options = {};
  options.weld = 1;
  EXPECT_THROW(build_plc({&soup, 1}, options), OptionError);
  options = {};
  options.planar_tolerance = NAN;
  EXPECT_THROW(build_plc({&soup, 1}, options), OptionError);
}

}  // namespace
}  // namespace collarmesh::plc_faults_test
