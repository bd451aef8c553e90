#include "common/found_in_ranges.h"

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <utility>

namespace collarmesh::found_in_ranges_test {
namespace {

TEST(FoundInRanges, IsInTheOrderOfWhatWasLookedAt) {
  using Found = std::pair<std::size_t, int>;
  for (const std::size_t count : {std::size_t{0}, std::size_t{1}, std::size_t{4096}, std::size_t{100'001}})
    for (const int threads : {1, 2}) {
      std::vector<Found> expected;
      for (std::size_t i = 0; i < count; ++i)
        for (int k = 0; k < static_cast<int>(i % 7) - 3; ++k) expected.push_back({i, k});
      std::vector<Found> found;
      tbb::task_arena(threads).execute([&] {
        found = found_in_ranges<Found>(count, [](std::size_t i, std::vector<Found>& all) {
          for (int k = 0; k < static_cast<int>(i % 7) - 3; ++k) all.push_back({i, k});
        });
      });
      EXPECT_EQ(found, expected);
    }
}

}  // namespace
}  // namespace collarmesh::found_in_ranges_test
