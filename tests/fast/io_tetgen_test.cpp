// TetGen's .poly, .smesh and .node.
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include "collarmesh/io/soup_io.h"
#include "support/replaced.h"
#include "support/temporary_file.h"

namespace collarmesh::io_tetgen_test {
namespace {

using testing::expect_error;
using testing::replaced;
using testing::TemporaryFolder;

const std::string nodes =
    "# a box\n"
    "8 3 2 1  # with 2 attributes and markers\n"
    "1  0 0 0  0.5 7  11\n"
    "2  2 0 0  0.5 7  12\n"
    "\n"
    "3  2 2 0  0.5 7  13\n"
    "4  0 2 0  0.5 7  14\n"
    "5  0 0 1e0  0.5 7  15\n"
    "6  2 0 1  0.5 7  16\n"
    "7  2 2 1  0.5 7  17\n"
    "8  0 2 1  0.5 7  -18\n";

const std::string facets =
    "4 1\n"
    "2 1 -5  # a facet with a hole\n"
    "4  1 2\n"
    "   3 4\n"
    "3  5 6 7\n"
    "1  1.5 0.5 0\n"
    "3 0 6\n"
    "4  1 2 6 5\n"
    "2  1 6  # a segment inside\n"
    "1  5    # a point inside\n"
    "1 0 8\n"
    "2  3 7\n"
    "1\n"
    "3  2 3 7\n";

const std::string holes_and_regions =
    "1\n"
    "1  0.5 0.5 0.5\n"
    "2  # regions\n"
    "1  0.1 0.2 0.3  10.0 0.001\n"
    "2  1.1 1.2 0.3  -20 -1\n";

std::vector<Index> corners(const PolygonSoup& soup, Index polygon) {
  const auto span = soup.polygon(polygon);
  return {span.begin(), span.end()};
}

void expect_box(const PolygonSoup& soup) {
  ASSERT_EQ(soup.points.size(), 8);
  EXPECT_EQ(soup.points[6], (Point{2, 2, 1}));
  EXPECT_EQ(soup.point_tags, (std::vector<Tag>{11, 12, 13, 14, 15, 16, 17, -18}));
  ASSERT_EQ(soup.facet_count(), 3);
  EXPECT_EQ(soup.facet_tag(0), -5);
  EXPECT_EQ(soup.facet_polygons(0), (std::array<Index, 2>{0, 2}));
  EXPECT_EQ(corners(soup, 0), (std::vector<Index>{0, 1, 2, 3}));
  EXPECT_EQ(corners(soup, 1), (std::vector<Index>{4, 5, 6}));
  ASSERT_EQ(soup.facet_holes.size(), 1);
  EXPECT_EQ(soup.facet_holes[0].facet, 0);
  EXPECT_EQ(soup.facet_holes[0].point, (Point{1.5, 0.5, 0}));
  EXPECT_EQ(soup.facet_tag(1), 6);
  EXPECT_EQ(corners(soup, 3), (std::vector<Index>{0, 5}));
  EXPECT_EQ(corners(soup, 4), (std::vector<Index>{4}));
  ASSERT_EQ(soup.segments.size(), 1);
  EXPECT_EQ(soup.segments[0].a, 2);
  EXPECT_EQ(soup.segments[0].b, 6);
  EXPECT_EQ(soup.segments[0].tag, 8);
  EXPECT_EQ(soup.facet_tag(2), 0);
  EXPECT_EQ(soup.hole_points, (std::vector<Point>{{0.5, 0.5, 0.5}}));
}

TEST(IoTetgen, ReadsPoly) {
  const TemporaryFolder folder;
  const PolygonSoup soup = io::read_soup(folder.write("box.poly", nodes + facets + holes_and_regions));
  expect_box(soup);
  ASSERT_EQ(soup.region_points.size(), 2);
  EXPECT_EQ(soup.region_points[0].tag, 10);
  EXPECT_EQ(soup.region_points[0].point, (Point{0.1, 0.2, 0.3}));
  // A regular tetrahedron of edge a has the volume a^3 / (6 sqrt 2).
  EXPECT_NEAR(std::pow(soup.region_points[0].size, 3) / (6 * std::sqrt(2.0)), 0.001, 1e-15);
  EXPECT_EQ(soup.region_points[1].tag, -20);
  EXPECT_EQ(soup.region_points[1].size, 0);
}

TEST(IoTetgen, TakesPointsFromTheNodeFile) {
  const TemporaryFolder folder;
  const std::string path = folder.write("box.poly", "0 3 0 0\n" + facets + holes_and_regions);
  expect_error<ReadError>([&] { io::read_soup(path); }, folder.file("box.node"), "No such file");
  folder.write("box.node", nodes);
  expect_box(io::read_soup(path));
  folder.write("box.node", nodes.substr(0, nodes.size() - 20));
  expect_error<ReadError>([&] { io::read_soup(path); }, folder.file("box.node"), "line ");
}

TEST(IoTetgen, HolesAndRegionsMayBeMissing) {
  const TemporaryFolder folder;
  expect_box(io::read_soup(folder.write("a.poly", nodes + facets + "1\n1 0.5 0.5 0.5")));
  const PolygonSoup soup = io::read_soup(folder.write("b.poly", nodes + facets));
  EXPECT_TRUE(soup.hole_points.empty());
  EXPECT_TRUE(soup.region_points.empty());
}

TEST(IoTetgen, ReadsSmesh) {
  const TemporaryFolder folder;
  const PolygonSoup soup =
      io::read_soup(folder.write("a.smesh",
                                 "5 3\r\n0 0 0 0\r\n1 1 0 0\r\n2 1 1 0\r\n3 0 1 0\r\n4 0.5 0.5 1\r\n"
                                 "3 1\r\n4 0 1 2\r\n  3 9\r\n3 0 1 4\r\n2 2 4 -3\r\n0\r\n0\r\n"
                                 "Anything may follow.\r\n"));
  EXPECT_EQ(soup.points.size(), 5);
  EXPECT_TRUE(soup.point_tags.empty());
  ASSERT_EQ(soup.facet_count(), 2);
  EXPECT_EQ(corners(soup, 0), (std::vector<Index>{0, 1, 2, 3}));
  EXPECT_EQ(soup.facet_tag(0), 9);
  EXPECT_EQ(soup.facet_tag(1), 0);
  ASSERT_EQ(soup.segments.size(), 1);
  EXPECT_EQ(soup.segments[0].tag, -3);
}

void expect_refused(const std::string& content, const std::string& part) {
  SCOPED_TRACE(content);
  const TemporaryFolder folder;
  const std::string path = folder.write("a.poly", content);
  expect_error<ReadError>([&] { io::read_soup(path); }, path, part);
}

TEST(IoTetgen, RefusesBadFiles) {
  const std::string all = nodes + facets + holes_and_regions;
  expect_refused("", "line 1: ");
  expect_refused("garbage", "line 1: expected the number of points");
  expect_refused(replaced(all, "8 3 2 1", "8 2 2 1"), "line 2: the dimension is 2");
  expect_refused(replaced(all, "8 3 2 1", "2000000000 3 2 1"), "line 2: the number of points is 2000000000");
  expect_refused(replaced(all, "8 3 2 1", "9 3 2 1"), "line 12: ");
  expect_refused(replaced(all, "1  0 0 0", "2  0 0 0"), "line 3: the first point has number 2");
  expect_refused(replaced(all, "3  2 2 0", "4  2 2 0"), "line 6: expected point number 3, found 4");
  expect_refused(replaced(all, "1e0", "nan"), "line 8: ");
  expect_refused(replaced(all, "4 1\n", "2000000000 1\n"), "line 12: the number of facets is 2000000000");
  expect_refused(replaced(all, "2 1 -5", "2000000000 1 -5"), "line 13: ");
  expect_refused(replaced(all, "2 1 -5", "2 2000000000 -5"), "line 13: ");
  expect_refused(replaced(all, "4  1 2\n", "2000000000  1 2\n"), "line 14: ");
  expect_refused(replaced(all, "   3 4", "   3 9"),
                 "line 15: a corner of a polygon is 9, but has to be from 1 to 8");
  expect_refused(replaced(all, "   3 4", "   3 0"), "line 15: ");
  expect_refused(replaced(all, "1  1.5 0.5 0", "1  1.5 0.5"), "line ");
  expect_refused(replaced(all, "2  3 7", "0"), "line ");
  expect_refused(replaced(all, "0.3  10.0", "0.3  ten"), "line 29: ");
  expect_refused(all.substr(0, all.size() - 20), "line 30: ");
  expect_refused((nodes + facets).substr(0, (nodes + facets).size() - 4), "line 25: ");
}

TEST(IoTetgen, SurvivesDamage) {
  const std::string all = nodes + facets + holes_and_regions;
  const TemporaryFolder folder;
  std::mt19937 random(3);
  for (int round = 0; round < 300; ++round) {
    std::string damaged = all.substr(0, round % 3 == 0 ? random() % all.size() : all.size());
    for (unsigned k = 0; k < random() % 4 && !damaged.empty(); ++k)
      damaged[random() % damaged.size()] = "0123456789-\n #.e"[random() % 16];
    try {
      const PolygonSoup soup = io::read_soup(folder.write(round % 2 == 0 ? "a.poly" : "a.smesh", damaged));
      for (Index q = 0; q < soup.polygon_count(); ++q)
        for (const Index corner : soup.polygon(q)) ASSERT_LT(corner, soup.points.size());
    } catch (const ReadError&) {
    }
  }
}

}  // namespace
}  // namespace collarmesh::io_tetgen_test
