// The small parts that refinement stands on: queue, location objects, frame.
#include <gtest/gtest.h>

#include <random>

#include "location/location_objects.h"
#include "refine/frame.h"
#include "refine/work_queue.h"

namespace collarmesh {
namespace {

TEST(WorkQueue, TakesTheFirstPriorityAndThenTheLargestBall) {
  WorkQueue queue(1.0);
  queue.push(WorkQueue::large_cells, 0.9, {1, 0});
  queue.push(WorkQueue::skinny_cells, 1e-6, {2, 0});
  queue.push(WorkQueue::skinny_cells, 0.5, {3, 0});
  queue.push(WorkQueue::encroached_subsegments, 1e-12, {4, 0});
  std::vector<Index> order;
  WorkQueue::Item item;
  while (queue.pop(item)) order.push_back(item.entry.id);
  EXPECT_EQ(order, (std::vector<Index>{4, 3, 2, 1}));
}

TEST(WorkQueue, TakesALargerBallThatComesLater) {
  WorkQueue queue(1.0);
  WorkQueue::Item item;
  queue.push(WorkQueue::large_cells, 1e-3, {1, 0});
  queue.push(WorkQueue::large_cells, 1e-3, {2, 0});
  ASSERT_TRUE(queue.pop(item));
  EXPECT_EQ(item.entry.id, 2U);  // last in, first out inside a bucket
  queue.push(WorkQueue::large_cells, 0.7, {3, 0});
  ASSERT_TRUE(queue.pop(item));
  EXPECT_EQ(item.entry.id, 3U);
  ASSERT_TRUE(queue.pop(item));
  EXPECT_EQ(item.entry.id, 1U);
  EXPECT_FALSE(queue.pop(item));
}

TEST(WorkQueue, OrderFollowsTheSizeWithinAFactorOfTwo) {
  WorkQueue queue(1.0);
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> exponent(-40, 0);
  std::vector<double> sizes;
  for (Index i = 0; i < 1000; ++i) {
    sizes.push_back(std::exp2(exponent(random)));
    queue.push(WorkQueue::large_cells, sizes.back(), {i, 0});
  }
  double before = INFINITY;
  WorkQueue::Item item;
  while (queue.pop(item)) {
    EXPECT_LE(sizes[item.entry.id], 2 * before);
    before = sizes[item.entry.id];
  }
}

TEST(LocationObjects, ListsFollowAdditionsMovesAndRemovals) {
  LocationObjects objects;
  std::vector<std::vector<Index>> expected(20);
  std::mt19937_64 random(9);
  std::vector<std::pair<Index, Index>> alive;  // object, vertex
  for (int step = 0; step < 3000; ++step) {
    const auto vertex = static_cast<Index>(random() % 20);
    const auto action = random() % 3;
    if (action == 0 || alive.empty()) {
      alive.push_back({objects.add(LocationObjects::Kind::point, 0, {}, 0, vertex), vertex});
    } else {
      const std::size_t k = random() % alive.size();
      if (action == 1) {
        objects.move(alive[k].first, vertex);
        alive[k].second = vertex;
      } else {
        objects.remove(alive[k].first);
        alive.erase(alive.begin() + static_cast<std::ptrdiff_t>(k));
      }
    }
    for (Index v = 0; v < 20; ++v) {
      std::size_t listed = 0, held = 0;
      for (Index o = objects.first_at(v); o != none; o = objects[o].next) {
        ++listed;
        EXPECT_EQ(objects[o].vertex, v);
      }
      for (const auto& [object, at] : alive) held += at == v;
      ASSERT_EQ(listed, held);
    }
  }
}

TEST(Frame, MovesFarInputWithoutRounding) {
  Box far;
  far.add(Point{1e6, -2e6 - 3, 0});
  far.add(Point{1e6 + 1, -2e6, 1});
  const Frame frame(far);
  EXPECT_EQ(frame.shift(), (Vector{1e6, -2e6, 0}));
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int k = 0; k < 1000; ++k) {
    const Point p{1e6 + unit(random), -2e6 - 3 * unit(random), unit(random)};
    EXPECT_EQ(frame.outside(frame.inside(p)), p);
    const Point made = frame.rounded({unit(random), -unit(random), unit(random)});
    EXPECT_EQ(frame.inside(frame.outside(made)), made);
  }
}

TEST(Frame, LeavesInputAroundTheOriginAlone) {
  Box box;
  box.add(Point{-1, 2, 0});
  box.add(Point{1, 5, 1});
  EXPECT_EQ(Frame(box).shift(), Vector{});
}

}  // namespace
}  // namespace collarmesh
