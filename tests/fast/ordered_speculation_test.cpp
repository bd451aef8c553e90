// Changes that several threads propose, in the order of one.
#include "remesh/ordered_speculation.h"

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <cstdint>
#include <vector>

namespace collarmesh::ordered_speculation_test {
namespace {

using remeshing::ChangeTimes;
using remeshing::OrderedSpeculation;

constexpr Index places = 40, items = 5000;

struct Adding {
  unsigned calls = 0;
};
struct Sum {
  std::uint64_t value;
  std::vector<Index> read;
};

/// Each item replaces the value at one place by a mix with the value at another place. Stops after `most`
/// changes. There may be more threads than cores.
std::vector<std::uint64_t> values_of(int threads, std::size_t most = items) {
  std::vector<std::uint64_t> values(places, 1);
  std::vector<Index> all(items);
  for (Index i = 0; i < items; ++i) all[i] = i;
  tbb::task_arena(threads).execute([&] {
    ChangeTimes times(places);
    OrderedSpeculation<Adding> speculation([] { return Adding(); });
    std::size_t used = 0;
    const bool ended = speculation.for_each<Sum>(
        all, times,
        [&](Adding& adding, Index item, Sum& sum) {
          ++adding.calls;
          sum.read = {item * 7 % places, item * 11 % places};
          sum.value = 31 * values[sum.read[0]] + values[sum.read[1]] + item;
        },
        [&](Index, const Sum& sum, std::uint32_t begun) { return !times.any_since(begun, sum.read); },
        [&](Index, const Sum& sum) {
          if (used == most) return false;
          ++used;
          times.note_next(sum.read[0]);
          values[sum.read[0]] = sum.value;
          return true;
        });
    EXPECT_EQ(ended, most == items);
    // Proposals are made ahead by others, and again where they met.
    if (threads > 1) {
      EXPECT_LT(speculation.own().calls, items);
    }
    EXPECT_GT(speculation.own().calls, 0U);
  });
  return values;
}

TEST(OrderedSpeculation, MakesTheChangesOfOneThread) {
  const auto alone = values_of(1);
  EXPECT_EQ(values_of(2), alone);
  EXPECT_EQ(values_of(5), alone);
}

TEST(OrderedSpeculation, StopsWhenAChangeSaysSo) {
  EXPECT_EQ(values_of(3, 17), values_of(1, 17));
  EXPECT_NE(values_of(1, 17), values_of(1, 18));
}

TEST(ChangeTimes, KnowWhatHasChangedSince) {
  const std::vector<Index> both{0, 1};
  ChangeTimes times(2);
  EXPECT_EQ(times.at(1), 0U);
  times.note_next(1);
  const std::uint32_t first = times.now();
  EXPECT_TRUE(times.any_since(first, both));
  EXPECT_TRUE(times.any_after(first - 1, both));
  EXPECT_FALSE(times.any_after(first, both));
  EXPECT_FALSE(times.any_since(first, std::vector<Index>{0}));
  EXPECT_FALSE(times.any_since(times.advance(), both));
  times.resize(3);
  times.note(2);
  EXPECT_TRUE(times.any_after(first, std::vector<Index>{2}));
}

}  // namespace
}  // namespace collarmesh::ordered_speculation_test
