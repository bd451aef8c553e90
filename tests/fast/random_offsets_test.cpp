// Random offsets of inserted points.
#include "refine/random_offsets.h"

#include <gtest/gtest.h>

#include <cmath>

namespace collarmesh::random_offsets_test {
namespace {

TEST(RefineRandomOffsets, AreShortOrthogonalAndTheSameForASeed) {
  const CollarSystem no_collars;
  RandomOffsets offsets(7, no_collars), same(7, no_collars), other(8, no_collars);
  const Vector normal{1, 2, 3};
  bool differs = false;
  for (int k = 0; k < 100; ++k) {
    const Vector v = offsets.outside_collars({0, 0, 0}, 0.1, normal);
    EXPECT_NEAR(dot(v, normal), 0, 1e-15);
    EXPECT_LE(norm(v), 0.1 * std::sqrt(3.0));
    EXPECT_EQ(v, same.outside_collars({0, 0, 0}, 0.1, normal));
    differs = differs || !(v == other.outside_collars({0, 0, 0}, 0.1, normal));
  }
  EXPECT_TRUE(differs);
}

}  // namespace
}  // namespace collarmesh::random_offsets_test
