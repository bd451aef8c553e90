// When repairs of collapses that have failed need not be tried again.
#include "coarsen/failed_repairs.h"

#include <gtest/gtest.h>

#include <vector>

namespace collarmesh::failed_repairs_test {
namespace {

using remeshing::ChangeTimes;
using remeshing::coarsening::FailedRepairs;

std::vector<Index> looked_at(const FailedRepairs& failed, Index vertex, const ChangeTimes& changes) {
  const auto found = failed.still_fails(vertex, changes);
  return {found.begin(), found.end()};
}

TEST(FailedRepairs, AreForgottenOnceAnythingChangesWhereTheyLooked) {
  ChangeTimes changes(5);
  for (const Index v : {2U, 4U, 1U}) changes.note_next(v);
  FailedRepairs failed;
  EXPECT_TRUE(looked_at(failed, 1, changes).empty());
  failed.note(1, {4, 1, 2, 4}, changes.now());
  EXPECT_EQ(looked_at(failed, 1, changes), (std::vector<Index>{1, 2, 4}));
  EXPECT_TRUE(looked_at(failed, 2, changes).empty());  // a vertex that was looked at, but not tried

  changes.note_next(3);  // elsewhere
  EXPECT_FALSE(looked_at(failed, 1, changes).empty());
  changes.note_next(2);
  EXPECT_TRUE(looked_at(failed, 1, changes).empty());
}

TEST(FailedRepairs, CountFromTheLastTrial) {
  ChangeTimes changes(4);
  FailedRepairs failed;
  failed.note(0, {0, 1}, changes.now());
  changes.note_next(1);
  failed.note(0, {0, 2}, changes.now());
  EXPECT_EQ(looked_at(failed, 0, changes), (std::vector<Index>{0, 2}));
  changes.note_next(2);
  EXPECT_TRUE(looked_at(failed, 0, changes).empty());
}

}  // namespace
}  // namespace collarmesh::failed_repairs_test
