// Every surface format on the same list of small surfaces, merging, and points inside regions.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string>
#include <vector>

#include "collarmesh/error.h"
#include "collarmesh/io/soup_io.h"
#include "collarmesh/merge_soups.h"
#include "collarmesh/plc_builder.h"
#include "support/temporary_file.h"

namespace collarmesh::io_soup_round_trip_test {
namespace {

using testing::expect_error;
using testing::TemporaryFolder;

PolygonSoup tetrahedron(Tag first_tag) {
  PolygonSoup soup;
  soup.points = {{0.1, -0.0, 1e-300}, {1, 0, 0}, {0, 1.0 / 3, 0}, {0, 0, 1e10}};
  Tag tag = first_tag;
  for (const auto& face : {std::array<Index, 3>{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}})
    soup.add_facet(face, first_tag == 0 ? 0 : tag++);
  return soup;
}

/// Returns a plate with a square hole, a segment and a region point.
PolygonSoup plate() {
  PolygonSoup soup;
  for (const double z : {0.0, 1.0})
    for (const auto& [x, y] :
         {std::array{0., 0.}, {4., 0.}, {4., 4.}, {0., 4.}, {1., 1.}, {3., 1.}, {3., 3.}, {1., 3.}})
      soup.points.push_back({x, y, z});
  soup.point_tags.assign(soup.points.size(), 3);
  for (const Index z : {0U, 8U}) {
    soup.begin_facet(z == 0 ? -7 : 5);
    soup.add_polygon(std::array<Index, 4>{z, z + 1, z + 2, z + 3});
    soup.add_polygon(std::array<Index, 4>{z + 4, z + 5, z + 6, z + 7});
    soup.facet_holes.push_back({soup.facet_count() - 1, {2, 2, z == 0 ? 0. : 1.}});
  }
  for (const Index ring : {0U, 4U})
    for (Index k = 0; k < 4; ++k)
      soup.add_facet(std::array<Index, 4>{ring + k, ring + (k + 1) % 4, ring + (k + 1) % 4 + 8, ring + k + 8},
                     9);
  soup.segments.push_back({0, 14, 77});
  soup.region_points.push_back({{0.5, 0.5, 0.5}, 42, 0.25});
  return soup;
}

std::vector<std::vector<Index>> polygons_of(const PolygonSoup& soup) {
  std::vector<std::vector<Index>> result;
  for (Index q = 0; q < soup.polygon_count(); ++q)
    result.emplace_back(soup.polygon(q).begin(), soup.polygon(q).end());
  return result;
}

PolygonSoup round_trip(const PolygonSoup& soup, const std::string& extension) {
  const TemporaryFolder folder;
  io::write_soup(folder.file("a" + extension), soup);
  EXPECT_EQ(folder.file_count(), 1);
  return io::read_soup(folder.file("a" + extension));
}

TEST(IoSoupRoundTrip, EveryFormatKeepsPointsAndFacets) {
  for (const std::string& extension : io::soup_formats())
    for (const Tag first_tag : {Tag{0}, Tag{-2}, Tag{100000}}) {
      SCOPED_TRACE(extension);
      const PolygonSoup soup = tetrahedron(first_tag);
      const PolygonSoup read = round_trip(soup, extension);
      ASSERT_EQ(read.facet_count(), soup.facet_count());
      const bool tags = extension != ".off" && extension != ".stl";
      for (Index f = 0; f < soup.facet_count(); ++f)
        EXPECT_EQ(read.facet_tag(f), tags ? soup.facet_tag(f) : 0);
      if (extension == ".stl") {  // 32-bit coordinates, points numbered by first use
        EXPECT_EQ(read.points.size(), 4);
        EXPECT_EQ(read.points[0].x, double{0.1F});
        continue;
      }
      EXPECT_EQ(read.points, soup.points);
      EXPECT_EQ(polygons_of(read), polygons_of(soup));
    }
}

TEST(IoSoupRoundTrip, PolyKeepsEverything) {
  const PolygonSoup soup = plate(), read = round_trip(soup, ".poly");
  EXPECT_EQ(read.points, soup.points);
  EXPECT_EQ(read.point_tags, soup.point_tags);
  EXPECT_EQ(polygons_of(read), polygons_of(soup));
  ASSERT_EQ(read.facet_holes.size(), 2);
  EXPECT_EQ(read.facet_holes[1].point, soup.facet_holes[1].point);
  ASSERT_EQ(read.segments.size(), 1);
  EXPECT_EQ(read.segments[0].tag, 77);
  ASSERT_EQ(read.region_points.size(), 1);
  EXPECT_EQ(read.region_points[0].tag, 42);
  EXPECT_NEAR(read.region_points[0].size, 0.25, 1e-12);
}

TEST(IoSoupRoundTrip, WhatAFormatCannotHoldIsAnError) {
  const TemporaryFolder folder;
  for (const std::string& extension : io::soup_formats()) {
    if (extension == ".poly") continue;
    const std::string path = folder.file("a" + extension);
    expect_error<WriteError>([&] { io::write_soup(path, plate()); }, path, "facet 0 has holes");
  }
  PolygonSoup quad;
  quad.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  quad.add_facet(std::array<Index, 4>{0, 1, 2, 3});
  expect_error<WriteError>([&] { io::write_soup(folder.file("b.stl"), quad); }, folder.file("b.stl"),
                           "facet 0 has 4 corners");
  expect_error<WriteError>([&] { io::write_soup("a.xyz", quad); }, "a.xyz", "unknown kind of file");
  EXPECT_EQ(folder.file_count(), 0);
}

double area_of(const PolygonSoup& soup) {
  double sum = 0;
  for (Index q = 0; q < soup.polygon_count(); ++q) {
    const auto c = soup.polygon(q);
    Vector twice;
    for (std::size_t k = 2; k < c.size(); ++k)
      twice = twice + cross(soup.points[c[k - 1]] - soup.points[c[0]], soup.points[c[k]] - soup.points[c[0]]);
    sum += 0.5 * norm(twice);
  }
  return sum;
}

TEST(MergeSoups, CutsWhatAFormatNeeds) {
  const PolygonSoup soup = plate();
  MergeReport report;
  const PolygonSoup kept = merge_soups({&soup, 1}, {}, report);
  EXPECT_EQ(polygons_of(kept), polygons_of(soup));
  EXPECT_EQ(kept.facet_holes.size(), 2);
  EXPECT_EQ(report.cut_facets, 0);
  const PolygonSoup simple = merge_soups({&soup, 1}, {.cut = CutFacets::complex}, report);
  EXPECT_EQ(report.cut_facets, 2);
  EXPECT_NEAR(area_of(simple), 2 * (16 - 4) + 16 + 8, 1e-12) << "the holes stay open";
  const PolygonSoup triangles = merge_soups({&soup, 1}, {.cut = CutFacets::all}, report);
  EXPECT_EQ(report.cut_facets, 10);
  EXPECT_NEAR(area_of(triangles), 48, 1e-12);
  for (const auto& polygon : polygons_of(triangles)) EXPECT_EQ(polygon.size(), 3);
  EXPECT_EQ(triangles.facet_tag(0), -7);
}

TEST(MergeSoups, WeldsAndDrops) {
  PolygonSoup a = tetrahedron(1), b;
  b.points = {{1, 0, 0}, {0, 1.0 / 3, 0}, {0, 0, 1e10}, {0, 0, 1e10}, {5, 5, 5}};
  b.add_facet(std::array<Index, 3>{2, 1, 0}, 50);  // the third facet of a, reversed
  b.add_facet(std::array<Index, 3>{0, 2, 3}, 51);  // two of its corners are welded
  MergeReport report;
  const std::array soups{a, b};
  const PolygonSoup merged = merge_soups(soups, {.weld = 0}, report);
  EXPECT_EQ(merged.facet_count(), 4);
  EXPECT_EQ(merged.points.size(), 4);
  EXPECT_EQ(report.welded_points, 4);
  EXPECT_EQ(report.unused_points, 1);
  EXPECT_EQ(report.degenerate_facets, 1);
  EXPECT_EQ(report.repeated_facets, 1);
}

TEST(MergeSoups, RefusesBadSoups) {
  MergeReport report;
  PolygonSoup bad = tetrahedron(0);
  bad.points[2].x = std::nan("");
  EXPECT_THROW(merge_soups({&bad, 1}, {}, report), PlcError);
  bad = tetrahedron(0);
  bad.add_facet(std::array<Index, 3>{0, 1, 9});
  EXPECT_THROW(merge_soups({&bad, 1}, {}, report), PlcError);
}

PolygonSoup box(const Point& low, const Point& high, bool inwards = false) {
  PolygonSoup soup;
  for (const double z : {low.z, high.z})
    for (const auto& [x, y] : {std::array{low.x, low.y}, {high.x, low.y}, {high.x, high.y}, {low.x, high.y}})
      soup.points.push_back({x, y, z});
  for (std::array<Index, 4> f : {std::array<Index, 4>{0, 3, 2, 1},
                                 {4, 5, 6, 7},
                                 {0, 1, 5, 4},
                                 {1, 2, 6, 5},
                                 {2, 3, 7, 6},
                                 {3, 0, 4, 7}}) {
    if (inwards) std::swap(f[1], f[3]);
    soup.add_facet(f);
  }
  return soup;
}

/// A solid in a cavity of a thin shell, beside another solid. Each region and the cavity get a point, and
/// these points lead to the same complex.
TEST(RegionPoints, DecideLikeTheOrientation) {
  const std::array soups{box({0, 0, 0}, {10, 10, 10}),
                         box({0.001, 0.001, 0.001}, {9.999, 9.999, 9.999}, true), box({4, 4, 4}, {6, 6, 6}),
                         box({10, 0, 0}, {11, 10, 10})};
  const Plc plc = build_plc(soups);
  ASSERT_EQ(plc.regions.size(), 4);
  MergeReport report;
  PolygonSoup merged = merge_soups(soups, {}, report);
  EXPECT_EQ(place_region_points(plc, merged), 0);
  EXPECT_EQ(merged.region_points.size(), 3);
  EXPECT_EQ(merged.hole_points.size(), 1);
  merged.name = "a.poly";
  const Plc again = build_plc({&merged, 1});
  ASSERT_EQ(again.regions.size(), 4);
  for (std::size_t r = 1; r < plc.regions.size(); ++r) {
    const auto same = std::find_if(again.regions.begin(), again.regions.end(),
                                   [&](const auto& other) { return other.tag == plc.regions[r].tag; });
    ASSERT_NE(same, again.regions.end());
    EXPECT_NEAR(same->volume, plc.regions[r].volume, 1e-9);
  }
}

}  // namespace
}  // namespace collarmesh::io_soup_round_trip_test
