#include "common/groups.h"

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <vector>

namespace collarmesh::groups_test {
namespace {

struct Item {
  std::size_t giver;
  int number;  // number among the items of its giver

  friend bool operator==(const Item&, const Item&) = default;
};
using Items = std::vector<Item>;

// Each giver has some items for some groups, drawn with its own seed.
template <class Give>
void items_of(std::size_t giver, std::size_t groups, const Give& give) {
  std::mt19937_64 random(giver);
  const int count = static_cast<int>(random() % 5);
  for (int number = 0; number < count; ++number) give(random() % groups, Item{giver, number});
}

void expect_groups(std::size_t groups, std::size_t givers) {
  std::map<std::size_t, Items> expected;
  for (std::size_t giver = 0; giver < givers; ++giver)
    items_of(giver, groups, [&](std::size_t group, const Item& item) { expected[group].push_back(item); });
  std::vector<Items> found(groups);
  for_each_group<Item>(
      groups, givers, [&](std::size_t giver, const auto& give) { items_of(giver, groups, give); },
      [&](std::size_t group, std::span<Item> items) {
        EXPECT_TRUE(found[group].empty());
        EXPECT_FALSE(items.empty());
        found[group].assign(items.begin(), items.end());
      });
  for (std::size_t group = 0; group < groups; ++group) EXPECT_EQ(found[group], expected[group]) << group;
}

TEST(Groups, HoldTheirItemsInOrder) {
  expect_groups(1, 3);
  expect_groups(7, 100);
  expect_groups(1024, 9000);
  expect_groups(5000, 40000);
  expect_groups(1100 * 1024, 20000);  // more ranges than are allowed
}

TEST(Groups, MayBeEmpty) {
  expect_groups(10, 0);
  expect_groups(100000, 1);
}

}  // namespace
}  // namespace collarmesh::groups_test
