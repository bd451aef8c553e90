// The work queue: priorities, and the largest ball first.
#include "refine/work_queue.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace collarmesh::work_queue_test {
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

}  // namespace
}  // namespace collarmesh::work_queue_test
