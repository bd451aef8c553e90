// When repairs of collapses that have failed need not be tried again.
#include "coarsen/failed_repairs.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

namespace collarmesh::failed_repairs_test {
namespace {

using remeshing::coarsening::Changes;
using remeshing::coarsening::FailedRepairs;

std::vector<Index> looked_at(const FailedRepairs& failed, Index vertex, const Changes& changes) {
  const auto found = failed.still_fails(vertex, changes);
  return {found.begin(), found.end()};
}

TEST(FailedRepairs, AreForgottenOnceAnythingChangesWhereTheyLooked) {
  Changes changes{5, {0, 5, 3, 0, 4}};
  FailedRepairs failed;
  EXPECT_TRUE(looked_at(failed, 1, changes).empty());
  failed.note(1, {4, 1, 2, 4}, changes.now);
  EXPECT_EQ(looked_at(failed, 1, changes), (std::vector<Index>{1, 2, 4}));
  EXPECT_TRUE(looked_at(failed, 2, changes).empty());  // a vertex that was looked at, but not tried

  changes.at_vertex[3] = ++changes.now;  // elsewhere
  EXPECT_FALSE(looked_at(failed, 1, changes).empty());
  changes.at_vertex[2] = ++changes.now;
  EXPECT_TRUE(looked_at(failed, 1, changes).empty());
}

TEST(FailedRepairs, CountFromTheLastTrial) {
  Changes changes{1, std::vector<std::uint32_t>(4, 0)};
  FailedRepairs failed;
  failed.note(0, {0, 1}, changes.now);
  changes.at_vertex[1] = ++changes.now;
  failed.note(0, {0, 2}, changes.now);
  EXPECT_EQ(looked_at(failed, 0, changes), (std::vector<Index>{0, 2}));
  changes.at_vertex[2] = ++changes.now;
  EXPECT_TRUE(looked_at(failed, 0, changes).empty());
}

}  // namespace
}  // namespace collarmesh::failed_repairs_test
