// The lists of objects that are found from mesh vertices.
#include "location/location_objects.h"

#include <gtest/gtest.h>

#include <random>
#include <utility>
#include <vector>

namespace collarmesh::location_objects_test {
namespace {

TEST(LocationObjects, ListsFollowAdditionsMovesAndRemovals) {
  LocationObjects objects;
  std::mt19937_64 random(9);
  std::vector<std::pair<Index, Index>> alive;  // pairs of an object and its vertex
  for (int step = 0; step < 3000; ++step) {
    const auto vertex = static_cast<Index>(random() % 20);
    const auto action = random() % 3;
    if (action == 0 || alive.empty()) {
      alive.push_back({objects.add(0, {}, 0, vertex), vertex});
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

}  // namespace
}  // namespace collarmesh::location_objects_test
