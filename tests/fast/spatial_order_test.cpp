#include "common/spatial_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "common/box_tree.h"
#include "common/distance_tree.h"
#include "common/groups.h"
#include "location/triangle_hierarchy.h"

namespace collarmesh::spatial_order_test {
namespace {

using Pairs = std::set<std::pair<Index, Index>>;

std::vector<Point> random_points(std::size_t n, double spread) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> exponent(-spread, 0), unit(-1, 1);
  std::vector<Point> points;
  for (std::size_t i = 0; i < n; ++i)
    points.push_back(std::pow(10, exponent(random)) * Point{unit(random), unit(random), unit(random)});
  return points;
}

// Returns the depth of the hierarchy of splits. Checks that every split has octree cells on both sides: no
// place of the first part lies beyond one of the second part.
std::size_t depth(std::span<const SpatialKey> keys) {
  if (keys.size() < 2) return 0;
  const std::size_t at = spatial_split(keys);
  EXPECT_GT(at, 0U);
  EXPECT_LT(at, keys.size());
  if (keys.front().place != keys.back().place) {
    EXPECT_LT(keys[at - 1].place, keys[at].place);
  }
  return 1 + std::max(depth(keys.first(at)), depth(keys.subspan(at)));
}

TEST(SpatialOrder, HasEachItemOnceAlongTheCurve) {
  for (const double spread : {0.0, 8.0, 300.0}) {
    const auto points = random_points(5000, spread);
    const auto keys = spatial_order(points);
    ASSERT_EQ(keys.size(), points.size());
    std::set<Index> items;
    for (const SpatialKey& key : keys) items.insert(key.item);
    EXPECT_EQ(items.size(), points.size());
    EXPECT_TRUE(std::is_sorted(keys.begin(), keys.end(),
                               [](const SpatialKey& a, const SpatialKey& b) { return a.place < b.place; }));
  }
}

TEST(SpatialOrder, OrdersWhatIsInOnePointByNumber) {
  std::vector<Point> points;
  for (Index i = 0; i < 200000; ++i) points.push_back({static_cast<double>(i % 3), 0, 1});
  const auto keys = spatial_order(points);
  for (std::size_t i = 1; i < keys.size(); ++i) {
    const SpatialKey &a = keys[i - 1], &b = keys[i];
    ASSERT_TRUE(a.place < b.place || (a.place == b.place && a.item < b.item)) << i;
  }
}

TEST(SpatialOrder, OrdersPointsOfAnyExtent) {
  const double least = std::numeric_limits<double>::denorm_min(), largest = 1.7e308;
  for (const double unit : {least, 1e-305, largest, HUGE_VAL, std::nan("")}) {
    std::vector<Point> points;
    for (Index i = 0; i < 50000; ++i)
      points.push_back(unit * Point{static_cast<double>(i % 3) - 1, unit == least ? i * 1.0 : 0.5, 0});
    const auto keys = spatial_order(points);
    std::set<Index> items;
    for (const SpatialKey& key : keys) items.insert(key.item);
    EXPECT_EQ(items.size(), points.size());
    EXPECT_LE(depth(keys), most_spatial_levels);
  }
}

// Returns a corner of the unit cube at every level of the octree, and many points in its first cell.
std::vector<Point> deep_points() {
  std::vector<Point> points;
  for (int level = 0; level < 21; ++level)
    for (std::size_t axis = 0; axis < 3; ++axis) {
      Point p;
      p[axis] = std::ldexp(1, -level);
      points.push_back(p);
    }
  points.resize(100000);
  return points;
}

TEST(SpatialOrder, BoundsTheDepth) {
  const auto keys = spatial_order(deep_points());
  EXPECT_GT(depth(keys), 60U);
  EXPECT_LE(depth(keys), most_spatial_levels);
}

TEST(SpatialOrder, HierarchiesOfAnyDepthCanBeSearched) {
  const auto points = deep_points();
  std::vector<std::array<Index, 3>> corners;
  std::vector<DistanceTree::Triangle> triangles;
  for (Index i = 0; i < points.size(); ++i) {
    corners.push_back({i, i, i});
    triangles.push_back({points[i], points[i], points[i]});
  }
  const TriangleHierarchy hierarchy(points, corners);
  const DistanceTree tree(triangles);
  for (const Point& p : {Point{}, Point{1, 1, 1}, Point{1e-5, 1e-5, 0}, Point{0, 0, 0.7}}) {
    double least = INFINITY;
    for (const Point& q : points) least = std::min(least, squared_distance(p, q));
    EXPECT_EQ(hierarchy.squared_distance_to(p), least);
    EXPECT_EQ(hierarchy.triangle_within(p, least), none);
    EXPECT_NE(hierarchy.triangle_within(p, 1.001 * least + 1e-30), none);
    EXPECT_DOUBLE_EQ(tree.nearest(p).distance, std::sqrt(least));
  }
}

TEST(SpatialOrder, NeighboursAlongTheCurveAreNear) {
  const auto points = random_points(8000, 0);
  const auto keys = spatial_order(points);
  double along = 0, given = 0;
  for (std::size_t i = 1; i < keys.size(); ++i) {
    along += distance(points[keys[i - 1].item], points[keys[i].item]);
    given += distance(points[i - 1], points[i]);
  }
  EXPECT_LT(along, 0.15 * given);
}

TEST(SpatialOrder, SplitsWhatLiesInOnePlace) {
  const std::vector<Point> points(1000, Point{1, 2, 3});
  const auto keys = spatial_order(points);
  EXPECT_EQ(keys.size(), points.size());
  EXPECT_EQ(depth(keys), 10U);
}

bool meet(const Box& a, const Box& b) {
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (a.max[axis] < b.min[axis] || b.max[axis] < a.min[axis]) return false;
  return true;
}

std::vector<Box> random_boxes(std::size_t n) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> side(0, 0.2);
  std::vector<Box> boxes;
  for (const Point& p : random_points(n, 1)) {
    Box box;
    box.add(p);
    box.add(p + Vector{side(random), side(random), side(random)});
    boxes.push_back(box);
  }
  return boxes;
}

Pairs pairs_of(const BoxTree& tree) {
  Pairs found;
  tree.for_each_pair([&](Index i, Index j) { EXPECT_TRUE(found.insert(std::minmax(i, j)).second); });
  return found;
}

TEST(BoxTree, FindsThePairsThatBruteForceFinds) {
  const auto boxes = random_boxes(600);
  Pairs expected;
  for (Index i = 0; i < boxes.size(); ++i)
    for (Index j = i + 1; j < boxes.size(); ++j)
      if (meet(boxes[i], boxes[j])) expected.emplace(i, j);
  EXPECT_GT(expected.size(), boxes.size());
  EXPECT_EQ(pairs_of(BoxTree(boxes)), expected);
}

// Makes groups of near items, as features are, and groups of far items.
TEST(BoxTree, LeavesOutPairsWithinAGroup) {
  const auto boxes = random_boxes(600);
  for (const bool near : {true, false}) {
    std::vector<Index> groups;
    for (Index i = 0; i < boxes.size(); ++i) groups.push_back(near ? (boxes[i].min.x < 0.1 ? 7 : 8) : i % 5);
    Pairs expected;
    for (Index i = 0; i < boxes.size(); ++i)
      for (Index j = i + 1; j < boxes.size(); ++j)
        if (groups[i] != groups[j] && meet(boxes[i], boxes[j])) expected.emplace(i, j);
    EXPECT_FALSE(expected.empty());
    EXPECT_EQ(pairs_of(BoxTree(boxes, groups)), expected);
  }
}

// Boxes much smaller than one cell of the space-filling curve through all boxes: parts of the order remain
// separate.
TEST(SpatialOrder, TellsApartWhatIsFarSmallerThanTheWhole) {
  auto boxes = random_boxes(4000);
  for (Box& box : boxes) {
    box.max = 1e-9 * (box.min + 0.05 * (box.max - box.min));
    box.min = 1e-9 * box.min;
  }
  Box far;
  far.add(Point{1, 1, 1});
  boxes.push_back(far);
  const auto bounds = [&](std::span<const SpatialKey> keys) {
    Box box;
    for (const SpatialKey& key : keys) box.add(boxes[key.item]);
    return box;
  };
  std::vector<Point> centres;
  for (const Box& box : boxes) centres.push_back(box.centre());
  const auto keys = spatial_order(centres);
  // Few of the 64 parts of the hierarchy meet.
  std::vector<Box> parts;
  for (std::size_t i = 0; i + 1 < keys.size(); i += keys.size() / 64)
    parts.push_back(bounds(std::span(keys).subspan(i, std::min(keys.size() / 64, keys.size() - i))));
  std::size_t meeting = 0;
  for (std::size_t i = 0; i < parts.size(); ++i)
    for (std::size_t j = i + 1; j < parts.size(); ++j) meeting += meet(parts[i], parts[j]) ? 1 : 0;
  EXPECT_LT(meeting, parts.size() * parts.size() / 6);
}

TEST(BoxTree, MissesNothingNearASegment) {
  const auto boxes = random_boxes(600);
  const BoxTree tree(boxes);
  const auto ends = random_points(100, 0);
  for (std::size_t s = 0; s + 1 < ends.size(); s += 2) {
    std::set<Index> found;
    tree.for_each_near_segment(ends[s], ends[s + 1], [&](Index i) { found.insert(i); });
    for (Index i = 0; i < boxes.size(); ++i)
      for (int k = 0; k <= 50; ++k) {
        const Point at = ends[s] + k / 50.0 * (ends[s + 1] - ends[s]);
        Box there;
        there.add(at);
        EXPECT_TRUE(!meet(boxes[i], there) || found.contains(i));
      }
    EXPECT_LT(found.size(), boxes.size());
  }
}

TEST(SpatialOrder, IsTheSameByAllThreads) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> anywhere(-1, 1);
  std::vector<Point> points;
  for (unsigned i = 0; i < 100000; ++i)
    points.push_back({anywhere(random), 0.01 * anywhere(random), std::pow(anywhere(random), 9)});
  for (unsigned i = 0; i < 50; ++i) points.push_back(points[7 * i]);
  const auto alone = spatial_order(points), together = spatial_order_by_all_threads(points);
  ASSERT_EQ(alone.size(), together.size());
  for (std::size_t i = 0; i < alone.size(); ++i) {
    EXPECT_EQ(alone[i].item, together[i].item);
    EXPECT_EQ(alone[i].place, together[i].place);
  }
}

TEST(OrderByGroup, IsStable) {
  constexpr std::size_t count = 50000, groups = 3000;
  const auto group_of = [](std::size_t i) { return i * i % groups; };
  std::vector<Index> expected(count);
  std::iota(expected.begin(), expected.end(), Index{0});
  std::stable_sort(expected.begin(), expected.end(),
                   [&](Index a, Index b) { return group_of(a) < group_of(b); });
  EXPECT_EQ(order_by_group(groups, count, group_of), expected);
  EXPECT_TRUE(order_by_group(groups, 0, group_of).empty());
}

}  // namespace
}  // namespace collarmesh::spatial_order_test
