#include "common/index_set.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

namespace collarmesh::index_set_test {
namespace {

TEST(IndexSet, TakesEachNumberOnceAndHasIt) {
  for (const Index range : {3U, 100U, 5000U, none - 1}) {
    IndexSet numbers;
    std::set<Index> expected;
    std::mt19937 random(range);
    for (int k = 0; k < 3000; ++k) {
      const auto i = static_cast<Index>(random() % range);
      EXPECT_EQ(numbers.contains(i), expected.contains(i)) << i;
      EXPECT_EQ(numbers.insert(i), expected.insert(i).second) << i;
      EXPECT_TRUE(numbers.contains(i)) << i;
    }
  }
}

}  // namespace
}  // namespace collarmesh::index_set_test
