// The creases that have no collar yet.
#include "refine/open_creases.h"

#include <gtest/gtest.h>

#include <array>
#include <vector>

namespace collarmesh::open_creases_test {
namespace {

TEST(OpenCreases, AreTouchedOnceUntilTheyAreTaken) {
  OpenCreases creases;
  for (const Index curve : {3U, 5U}) creases.open(curve);
  EXPECT_FALSE(creases.any_touched());
  creases.touch(4);  // this crease is not open
  EXPECT_FALSE(creases.any_touched());
  creases.touch(3);
  creases.note_link(5, {7, 1});
  creases.touch(5);
  creases.touch(3);
  EXPECT_EQ(creases.take_touched(), 5U);
  creases.touch(5);
  creases.close(5);
  EXPECT_EQ(creases.take_touched(), none);
  EXPECT_EQ(creases.take_touched(), 3U);
  EXPECT_FALSE(creases.any_touched());
  EXPECT_EQ(creases.curves(), std::vector<Index>{3});
}

TEST(OpenCreases, KnowTheirChains) {
  OpenCreases creases;
  creases.open(2);
  creases.note_unresolved(2);
  creases.note_unresolved(2);
  creases.note_unresolved(1);
  EXPECT_EQ(creases.chain(2).unresolved, 2U);
  EXPECT_FALSE(creases.note_resolved(2));
  creases.note_link(2, {10, 0});
  creases.note_link(2, {11, 4});
  creases.note_end(2, 1, 30);
  EXPECT_FALSE(creases.is_open(1));
  const OpenCreases::Chain chain = creases.close(2);
  EXPECT_EQ(chain.unresolved, 1U);
  EXPECT_FALSE(chain.split);
  ASSERT_EQ(chain.links.size(), 2U);
  EXPECT_EQ(chain.links[1].subsegment, 11U);
  EXPECT_EQ(chain.links[1].stamp, 4U);
  EXPECT_EQ(chain.ends, (std::array<Index, 2>{none, 30}));
  EXPECT_FALSE(creases.is_open(2));
}

TEST(OpenCreases, TellWhenASplitChainIsComplete) {
  OpenCreases creases;
  for (const Index curve : {1U, 2U}) creases.open(curve);
  for (const Index curve : {1U, 2U})
    for (int end = 0; end < 2; ++end) creases.note_unresolved(curve);
  creases.note_split(1);
  EXPECT_FALSE(creases.note_resolved(1));
  EXPECT_TRUE(creases.note_resolved(1));
  EXPECT_FALSE(creases.note_resolved(2));
  EXPECT_FALSE(creases.note_resolved(2));  // the chain was not split
  EXPECT_FALSE(creases.note_resolved(3));  // this crease is not open
}

}  // namespace
}  // namespace collarmesh::open_creases_test
