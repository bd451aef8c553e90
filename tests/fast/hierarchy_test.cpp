#include "common/hierarchy.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <set>
#include <vector>

#include "common/distances.h"

namespace collarmesh::hierarchy_test {
namespace {

std::vector<Point> points_in_a_cube(std::size_t count, unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> coordinate(0, 1);
  std::vector<Point> points;
  for (std::size_t i = 0; i < count; ++i)
    points.push_back({coordinate(random), coordinate(random), coordinate(random)});
  return points;
}

/// A tree over points whose items are the numbers of the points.
struct Tree {
  std::vector<Point> points;
  std::vector<Index> order;  // numbers by place
  Hierarchy<Box> tree;

  const Point& at(Index place) const { return points[order[place]]; }
};

enum class Split { spatial, median };

Tree tree_over(std::size_t count, Split split, Index leaf_size) {
  Tree made{points_in_a_cube(count, 3), {}, {}};
  const auto box_of = [&](Index first, Index size) {
    Box box;
    for (Index i = first; i < first + size; ++i) box.add(made.at(i));
    return box;
  };
  const auto n = static_cast<Index>(count);
  made.order.resize(count);
  if (split == Split::spatial) {
    const auto keys = spatial_order(made.points);
    std::transform(keys.begin(), keys.end(), made.order.begin(), [](const SpatialKey& k) { return k.item; });
    made.tree.add(0, n, leaf_size, spatial_splits(keys), box_of, joined);
  } else {
    std::iota(made.order.begin(), made.order.end(), Index{0});
    const auto place_of = [&](Index i) { return made.points[i]; };
    made.tree.add(0, n, leaf_size, median_splits(std::span(made.order), place_of), box_of, joined);
  }
  return made;
}

std::vector<Tree> trees() {
  std::vector<Tree> all;
  for (const std::size_t count : {1, 2, 7, 500})
    for (const Split split : {Split::spatial, Split::median})
      for (const Index leaf_size : {1, 4}) all.push_back(tree_over(count, split, leaf_size));
  return all;
}

TEST(Hierarchy, HasEveryItemInOneLeafAndInTheBoundsAbove) {
  for (const Tree& made : trees()) {
    std::multiset<Index> seen;
    const auto visit = [&](Index node, const auto& self) -> Box {
      Box box;
      if (made.tree.is_leaf(node)) {
        for (Index i = made.tree.first(node); i < made.tree.end(node); ++i) {
          seen.insert(made.order[i]);
          box.add(made.at(i));
        }
      } else {
        box = joined(self(made.tree.left(node), self), self(made.tree.right(node), self));
      }
      EXPECT_EQ(made.tree.bounds(node).min, box.min);
      EXPECT_EQ(made.tree.bounds(node).max, box.max);
      return box;
    };
    visit(0, visit);
    EXPECT_EQ(seen.size(), made.points.size());
    EXPECT_EQ(std::set<Index>(seen.begin(), seen.end()).size(), made.points.size());
  }
}

TEST(Hierarchy, DescendsInBothOrdersToTheSameItems) {
  Box box;
  box.add(Point{0.2, 0.1, 0.3});
  box.add(Point{0.7, 0.6, 0.8});
  const auto meets = [&](const Box& bounds) { return boxes_meet(bounds, box); };
  for (const Tree& made : trees()) {
    std::vector<Index> forwards, backwards;
    const auto note = [&](std::vector<Index>& list, Index i) {
      if (squared_distance_to_box(made.at(i), box) == 0) list.push_back(i);
    };
    made.tree.descend(0, meets, [&](Index i) { note(forwards, i); });
    made.tree.descend<ChildOrder::right_first>(0, meets, [&](Index i) { note(backwards, i); });
    EXPECT_TRUE(std::is_sorted(forwards.begin(), forwards.end()));
    std::sort(backwards.begin(), backwards.end());
    EXPECT_EQ(forwards, backwards);
    const auto inside = std::count_if(made.points.begin(), made.points.end(),
                                      [&](const Point& p) { return squared_distance_to_box(p, box) == 0; });
    EXPECT_EQ(forwards.size(), static_cast<std::size_t>(inside));
  }
}

TEST(Hierarchy, EndsASearchWhenAsked) {
  const Tree made = tree_over(500, Split::spatial, 4);
  std::size_t seen = 0;
  const auto all = [](const Box&) { return true; };
  EXPECT_TRUE(made.tree.descend(0, all, [&](Index) { return ++seen == 10; }));
  EXPECT_EQ(seen, 10U);
  EXPECT_FALSE(made.tree.descend(0, all, [](Index) { return false; }));
}

TEST(Hierarchy, FindsTheNearestItemAndLooksAtFew) {
  for (const Tree& made : trees())
    for (const Point& p : points_in_a_cube(50, 4)) {
      double bound = INFINITY;
      std::size_t looks = 0;
      made.tree.visit_near(
          0, bound, [&](Index node) { return squared_distance_to_box(p, made.tree.bounds(node)); },
          [&](Index i) {
            ++looks;
            bound = std::min(bound, squared_distance(p, made.at(i)));
          });
      double least = INFINITY;
      for (const Point& q : made.points) least = std::min(least, squared_distance(p, q));
      EXPECT_EQ(bound, least);
      if (made.points.size() == 500) {
        EXPECT_LT(looks, 100U);
      }
    }
}

TEST(Hierarchy, ItemsCanBeNumberedAnew) {
  Tree made = tree_over(500, Split::median, 1);
  made.tree.renumber([&](Index place) { return made.order[place]; });
  std::set<Index> seen;
  made.tree.descend(
      0, [](const Box&) { return true; }, [&](Index i) { seen.insert(i); });
  EXPECT_EQ(seen.size(), made.points.size());
  for (Index node = 0; node < made.tree.node_count(); ++node)
    if (made.tree.is_leaf(node)) {
      EXPECT_EQ(made.tree.bounds(node).min, made.points[made.tree.first(node)]);
    }
}

}  // namespace
}  // namespace collarmesh::hierarchy_test
