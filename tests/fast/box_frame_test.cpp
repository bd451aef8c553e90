#include "common/box_frame.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>
#include <vector>

#include "common/box_tree.h"
#include "support/shapes.h"

namespace collarmesh::box_frame_test {
namespace {

using Triangles = std::vector<std::array<Index, 3>>;

// A strip of needles along a slanted direction, beside each other.
struct Needles {
  std::vector<Point> points;
  Triangles triangles;

  explicit Needles(Index count) {
    const Vector along = Vector{3, 5, 7} / std::sqrt(83.), across = Vector{5, -3, 0} / std::sqrt(34.);
    for (Index i = 0; i <= count; ++i) {
      points.push_back(Point{} + 0.01 * i * across);
      points.push_back(Point{} + 0.01 * i * across + 1000 * along);
    }
    for (Index i = 0; i < count; ++i) {
      triangles.push_back({2 * i, 2 * i + 2, 2 * i + 1});
      triangles.push_back({2 * i + 1, 2 * i + 2, 2 * i + 3});
    }
  }
};

std::set<std::pair<Index, Index>> pairs(const std::vector<Point>& points, const Triangles& triangles,
                                        const BoxFrame& frame) {
  std::vector<Box> boxes(triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (const Index p : triangles[t]) frame.add(boxes[t], points[p]);
  std::set<std::pair<Index, Index>> found;
  BoxTree(boxes).for_each_pair([&](Index i, Index j) { found.insert(std::minmax(i, j)); });
  return found;
}

TEST(BoxFrame, TurnsWithSlantedNeedlesSoThatFewBoxesMeet) {
  const Needles needles(300);
  const BoxFrame frame(needles.points, needles.triangles);
  ASSERT_TRUE(frame.turned());
  const auto found = pairs(needles.points, needles.triangles, frame);
  EXPECT_LT(found.size(), 10 * needles.triangles.size());
  EXPECT_GT(pairs(needles.points, needles.triangles, {}).size(), 100 * needles.triangles.size());
  for (Index i = 0; i < needles.triangles.size(); ++i)
    for (Index j = i + 1; j < needles.triangles.size(); ++j) {
      const auto &s = needles.triangles[i], &t = needles.triangles[j];
      const bool touch = std::any_of(s.begin(), s.end(),
                                     [&](Index p) { return std::find(t.begin(), t.end(), p) != t.end(); });
      EXPECT_TRUE(!touch || found.contains({i, j})) << i << ' ' << j;
    }
}

TEST(BoxFrame, KeepsTheAxesOfOtherTriangles) {
  const PolygonSoup ball = testing::icosphere(1, 8);
  Triangles triangles;
  for (Index f = 0; f < ball.facet_count(); ++f) {
    const auto corners = ball.polygon(ball.facet_polygons(f)[0]);
    triangles.push_back({corners[0], corners[1], corners[2]});
  }
  EXPECT_FALSE(BoxFrame(ball.points, triangles).turned());
  EXPECT_FALSE(BoxFrame(ball.points, {}).turned());
  EXPECT_FALSE(BoxFrame(std::vector<Point>(3), Triangles{{0, 1, 2}}).turned());
  Box box;
  BoxFrame().add(box, {1, 2, 3}, 0.5);
  EXPECT_EQ(box.min, (Point{0.5, 1.5, 2.5}));
  EXPECT_EQ(box.max, (Point{1.5, 2.5, 3.5}));
}

}  // namespace
}  // namespace collarmesh::box_frame_test
