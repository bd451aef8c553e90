#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

#include "collarmesh/plc_builder.h"
#include "facets/cleanup.h"
#include "facets/edges.h"
#include "support/plc_shapes.h"

namespace collarmesh::plc_facets_test {
namespace {

double area(const Plc& plc, Index patch) {
  Vector sum{};
  const Plc::Patch& p = plc.patches[patch];
  for (Index t = p.first_triangle; t < p.first_triangle + p.triangle_count; ++t) {
    const auto& [a, b, c] = plc.triangles[t].points;
    sum = sum + cross(plc.points[b] - plc.points[a], plc.points[c] - plc.points[a]);
  }
  return norm(sum) / 2;
}

Plc build_open(const PolygonSoup& soup) {
  PlcOptions options;
  options.require_solid = false;
  Plc plc = build_plc({&soup, 1}, options);
  EXPECT_EQ(testing::findings(plc), std::vector<std::string>{});
  return plc;
}

// Returns a square of side 4 with a square of side 2 inside.
PolygonSoup square_in_square(bool hole) {
  PolygonSoup soup;
  soup.points = {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}, {1, 1, 0}, {3, 1, 0}, {3, 3, 0}, {1, 3, 0}};
  soup.begin_facet(5);
  soup.add_polygon(std::array<Index, 4>{0, 1, 2, 3});
  soup.add_polygon(std::array<Index, 4>{4, 5, 6, 7});
  if (hole) soup.facet_holes.push_back({0, {2, 2, 0}});
  return soup;
}

TEST(PlcFacets, HoleIsCutOut) {
  const Plc plc = build_open(testing::moved(square_in_square(true), 4, 1, 2));
  ASSERT_EQ(plc.patches.size(), 1U);
  EXPECT_NEAR(area(plc, 0), 12, 1e-12);
  EXPECT_EQ(plc.patches[0].tag, 5);
  EXPECT_TRUE(plc.patches[0].planar);
  EXPECT_EQ(plc.curves.size(), 8U);
}

TEST(PlcFacets, InnerPolygonWithoutHoleIsEmbedded) {
  const Plc plc = build_open(square_in_square(false));
  ASSERT_EQ(plc.patches.size(), 2U);
  EXPECT_DOUBLE_EQ(area(plc, 0) + area(plc, 1), 16);
  EXPECT_EQ(plc.curves.size(), 8U);
}

TEST(PlcFacets, ConcaveOutlineIsNotFilled) {
  PolygonSoup soup;
  soup.points = {{0, 0, 1}, {2, 0, 1}, {2, 1, 1}, {1, 1, 1}, {1, 2, 1}, {0, 2, 1}};
  soup.add_facet(std::array<Index, 6>{0, 1, 2, 3, 4, 5});
  EXPECT_DOUBLE_EQ(area(build_open(soup), 0), 3);
}

TEST(PlcFacets, ConcaveQuadrangle) {
  PolygonSoup soup;
  soup.points = {{0, 0, 1}, {4, 0, 1}, {1, 1, 1}, {0, 4, 1}};
  soup.add_facet(std::array<Index, 4>{0, 1, 2, 3});
  EXPECT_DOUBLE_EQ(area(build_open(soup), 0), 4);
}

TEST(PlcFacets, SegmentsAndPointsInsideAFacet) {
  PolygonSoup soup = square_in_square(true);
  soup.points.insert(soup.points.end(), {{0.5, 0.5, 0}, {0.5, 3.5, 0}, {3.5, 3.5, 0}});
  soup.add_polygon(std::array<Index, 2>{8, 9});
  soup.add_polygon(std::array<Index, 1>{10});
  const Plc plc = build_open(soup);
  ASSERT_EQ(plc.patches.size(), 1U);
  EXPECT_DOUBLE_EQ(area(plc, 0), 12);
  EXPECT_EQ(plc.curves.size(), 9U);
  EXPECT_EQ(plc.vertices.size(), 11U);
  EXPECT_EQ(plc.patches[0].vertices.size(), 11U);
  EXPECT_EQ(plc.patches[0].curves.size(), 9U);
}

TEST(PlcFacets, RepeatedCornersAreOne) {
  PolygonSoup soup;
  soup.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {1, 1, 0}};
  soup.add_facet(std::array<Index, 6>{0, 1, 2, 4, 3, 3});
  const Plc plc = build_open(soup);
  EXPECT_DOUBLE_EQ(area(plc, 0), 1);
  EXPECT_EQ(plc.points.size(), 4U);
}

TEST(PlcFacets, TornSurfaceIsWelded) {
  const PolygonSoup soup = testing::torn_apart(testing::subdivided_box({0, 0, 0}, {1, 1, 1}, 5));
  const Plc plc = build_plc({&soup, 1});
  EXPECT_EQ(plc.points.size(), 6 * 25U + 2);
  EXPECT_EQ(plc.patches.size(), 6U);
}

TEST(PlcFacets, WeldDistanceIsRelativeAndReported) {
  PolygonSoup soup = testing::torn_apart(testing::polygonal_box({0, 0, 0}, {100, 100, 100}));
  soup.points[0].x += 1e-3;
  PlcOptions options;
  EXPECT_THROW(build_plc({&soup, 1}, options), PlcError);
  options.weld = 1e-5;
  options.planar_tolerance = 1e-5;
  const Plc plc = build_plc({&soup, 1}, options);
  EXPECT_EQ(plc.points.size(), 8U);
  EXPECT_NEAR(plc.largest_deviation, 1e-3, 1e-9);
}

TEST(PlcFacets, CollapsedAndRepeatedTrianglesAreDropped) {
  PolygonSoup soup = testing::subdivided_box({0, 0, 0}, {1, 1, 1}, 1);
  soup.add_facet(std::array<Index, 3>{0, 0, 1});
  const auto first = soup.polygon(0);
  soup.add_facet(std::vector<Index>(first.begin(), first.end()));
  soup.add_facet(std::vector<Index>(first.rbegin(), first.rend()));
  const Plc plc = build_plc({&soup, 1});
  EXPECT_EQ(plc.triangles.size(), 12U);
  EXPECT_DOUBLE_EQ(plc.regions[1].volume, 1);
}

TEST(PlcFacets, CollinearTrianglesAreReplacedByCuts) {
  // A cube whose edges and diagonals have extra points, closed by triangles without area.
  PolygonSoup soup;
  soup.points = testing::polygonal_box({0, 0, 0}, {1, 1, 1}).points;
  soup.points.insert(soup.points.end(),
                     {{0.5, 0, 1}, {0.25, 0, 1}, {0.75, 0, 1}});  // points 8, 9, 10 on the edge 4 5
  const auto facet = [&](std::array<Index, 3> corners) { soup.add_facet(corners); };
  for (const auto& t : {std::array<Index, 3>{0, 2, 3},
                        {0, 3, 1},
                        {2, 6, 7},
                        {2, 7, 3},
                        {0, 4, 6},
                        {0, 6, 2},
                        {1, 3, 7},
                        {1, 7, 5}})
    facet(t);
  facet({0, 1, 4});
  facet({1, 5, 4});
  facet({4, 9, 6});
  facet({9, 10, 6});
  facet({10, 5, 6});
  facet({5, 7, 6});
  // Closes the surface between the long edge 5 4 and the chain 4 9 10 5 by triangles without area.
  facet({4, 5, 8});
  facet({4, 8, 9});
  facet({8, 5, 10});
  facet({9, 8, 10});
  const Plc plc = build_plc({&soup, 1});
  EXPECT_EQ(testing::findings(plc), std::vector<std::string>{});
  EXPECT_EQ(plc.patches.size(), 6U);
  EXPECT_EQ(plc.curves.size(), 12U);
  EXPECT_DOUBLE_EQ(plc.regions[1].volume, 1);
  for (const auto& t : plc.triangles) {
    const Point &a = plc.points[t.points[0]], &b = plc.points[t.points[1]], &c = plc.points[t.points[2]];
    EXPECT_GT(norm(cross(b - a, c - a)), 0);
  }
}

// A triangle without area whose long side is also a segment.
TEST(CollinearTriangles, SegmentsAreCutLikeTheEdges) {
  facets::ComplexDraft draft;
  draft.points = {{0, 0, 0}, {4, 0, 0}, {1, 0, 0}, {3, 0, 0}, {2, 2, 0}};
  draft.add_triangle({0, 1, 2}, {});
  draft.add_triangle({2, 1, 3}, {});
  draft.add_triangle({0, 1, 4}, {});
  draft.segments.push_back({.a = 1, .b = 0, .tag = 7});
  draft.segments.push_back({.a = 0, .b = 4, .tag = 8});
  facets::remove_collinear_triangles(draft);
  std::vector<std::array<Index, 2>> seven;
  for (const facets::Segment& segment : draft.segments)
    if (segment.tag == 7) seven.push_back({segment.a, segment.b});
  EXPECT_EQ(seven, (std::vector<std::array<Index, 2>>{{1, 3}, {3, 2}, {2, 0}}));
  EXPECT_EQ(draft.segments.size(), 4U);
  ASSERT_EQ(draft.triangles.size(), 3U);
  for (Index t = 0; t < 3; ++t)
    EXPECT_GT(norm(cross(draft.corner(t, 1) - draft.corner(t, 0), draft.corner(t, 2) - draft.corner(t, 0))),
              0);
}

TEST(EdgeTable, ListsTheSidesOfEachEdge) {
  const std::vector<facets::Corners> triangles{{0, 1, 2}, {2, 1, 3}, {1, 2, 4}};
  const facets::EdgeTable edges(triangles, 5);
  EXPECT_EQ(edges.size(), 7U);
  const Index common = edges.find(2, 1);
  ASSERT_NE(common, none);
  EXPECT_EQ(edges.sides(common).size(), 3U);
  for (const Index side : edges.sides(common)) EXPECT_EQ(edges.edge_of(side), common);
  EXPECT_EQ(edges.find(0, 3), none);
  EXPECT_TRUE(facets::ascending(triangles, edges.sides(common)[0]));
  EXPECT_FALSE(facets::ascending(triangles, edges.sides(common)[1]));
}

}  // namespace
}  // namespace collarmesh::plc_facets_test
