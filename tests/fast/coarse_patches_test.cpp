// The estimate of the distance of a patch's triangles from its surface, which says how much finer a CAD face
// has to be triangulated.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "collarmesh/plc_builder.h"
#include "collarmesh/surface_tolerance.h"
#include "support/shapes.h"

namespace collarmesh::testing::coarse_patches_test {
namespace {

constexpr double radius = 2, tolerance = 0.01;

double sagitta(unsigned segments) { return radius * (1 - std::cos(std::numbers::pi / segments)); }

std::vector<CoarsePatch> coarse(unsigned segments) {
  return coarse_patches(build_plc({{cylinder(radius, 1, segments)}}), SurfaceTolerance(tolerance));
}

TEST(CoarsePatches, TellHowFarTrianglesAreFromTheSurface) {
  for (const unsigned segments : {16, 24, 36}) {
    const std::vector<CoarsePatch> found = coarse(segments);
    ASSERT_EQ(found.size(), 1U);
    EXPECT_NEAR(found.front().by, sagitta(segments) / (tolerance / 4), 0.02 * found.front().by);
  }
}

TEST(CoarsePatches, AreNoneIfTrianglesAreWithinAQuarterOfTheTolerance) {
  unsigned segments = 36;
  while (sagitta(segments) > tolerance / 4) ++segments;
  EXPECT_FALSE(coarse(segments - 2).empty());
  EXPECT_TRUE(coarse(segments + 1).empty());
}

}  // namespace
}  // namespace collarmesh::testing::coarse_patches_test
