// Complexes with curved walls far thinner than the chords of their elements, and the sizes of places that are
// thinner than a limit.
#include "tolerance/thin_shells.h"

#include <gtest/gtest.h>

#include <vector>

#include "collarmesh/plc_builder.h"
#include "support/shapes.h"
#include "tolerance/thickness.h"
#include "tolerance/thin_places.h"

namespace collarmesh::thin_shells_test {
namespace {

using namespace testing;

constexpr double size = 1;

bool has_thin(const std::vector<PolygonSoup>& soups) {
  const Plc plc = build_plc(soups);
  return has_thin_shells(plc, default_tolerance(plc, size), size);
}

PolygonSoup hollow_ball(double radius, double thickness) {
  return joined(uv_sphere(radius, 12, 24), inverted(uv_sphere(radius - thickness, 12, 24)));
}

TEST(ThinShells, AreHollowBallsFarThinnerThanTheSize) {
  EXPECT_TRUE(has_thin({hollow_ball(6, 0.002)}));
  EXPECT_TRUE(has_thin({hollow_ball(6, 0.05)}));
  EXPECT_FALSE(has_thin({hollow_ball(6, 0.5)}));
}

TEST(ThinShells, AreCoatings) {
  EXPECT_TRUE(has_thin({uv_sphere(6, 12, 24), uv_sphere(5.97, 12, 24)}));
  EXPECT_FALSE(has_thin({uv_sphere(6, 12, 24), uv_sphere(4, 12, 24)}));
}

// Elements may be long along a tube, however short chords around it are.
TEST(ThinShells, AreTubes) {
  const auto tube = [](double radius) {
    const std::vector<Point> profile{
        {0.9 * radius, 0, 0}, {radius, 0, 0}, {radius, 0, 20}, {0.9 * radius, 0, 20}};
    return revolution(profile, 24, true);
  };
  EXPECT_TRUE(has_thin({tube(0.1)}));
  EXPECT_TRUE(has_thin({tube(0.005)}));
  EXPECT_FALSE(has_thin({tube(6)}));
}

// Around a thin rod chords are as short as the rod is thin; planar sheets need no elements as short as the
// gap between them.
TEST(ThinShells, AreNeitherRodsNorPlates) {
  EXPECT_FALSE(has_thin({cylinder(0.02, 20, 24)}));
  EXPECT_FALSE(has_thin({box({0, 0, 0}, {20, 20, 0.01})}));
  EXPECT_FALSE(has_thin({icosphere(6, 8)}));
}

// If curved walls are too small, refinement is cheap anyway.
TEST(ThinShells, AreNotSmallOnes) { EXPECT_FALSE(has_thin({hollow_ball(0.3, 0.02)})); }

TEST(ThinPlaces, AreCountedInSquaresAsLongAsTheyAreThin) {
  const Plc plate = build_plc(std::vector{box({0, 0, 0}, {10, 10, 0.1})});
  EXPECT_NEAR(squares_in_thin_places(plate, 0.11), 2 * 100 / 0.01, 1e-6);
  EXPECT_EQ(squares_in_thin_places(plate, 0.09), 0);
}

TEST(ThinPlaces, AreGapsAndWedges) {
  const Plc gap = build_plc(std::vector{box({0, 0, 0}, {10, 10, 3}), box({0, 0, 3.1}, {10, 10, 6})});
  EXPECT_NEAR(squares_in_thin_places(gap, 0.11), 2 * 100 / 0.01, 1e-6);
  const Plc wedge = build_plc(std::vector{transformed(box({0, 0, 0}, {10, 10, 1}), [](const Point& p) {
    return Point{p.x, p.y, p.z * 0.1 * (1 + p.x)};
  })});
  EXPECT_GT(squares_in_thin_places(wedge, 2), 200);
  EXPECT_EQ(squares_in_thin_places(wedge, 0.05), 0);
  const PolygonSoup one = cylinder(3, 10, 72);
  EXPECT_EQ(squares_in_thin_places(build_plc(std::vector{one, translated(one, {6.01, 0, 0})}), 0.1), 0);
}

void expect_same_within(double reach, const Thickness::Opposite& any, const Thickness::Opposite& within) {
  if (any.distance < reach) {
    EXPECT_EQ(within.triangle, any.triangle);
    EXPECT_EQ(within.side, any.side);
    EXPECT_DOUBLE_EQ(within.distance, any.distance);
  } else {
    EXPECT_EQ(within.triangle, none);
  }
}

TEST(Thickness, WithinAReachIsThatOfUnlimitedRays) {
  const PolygonSoup tube =
      joined(cylinder(1, 4, 31), inverted(translated(cylinder(0.83, 3.7, 23), {0, 0, 0.15})));
  std::size_t within = 0, beyond = 0;
  for (const PolygonSoup& soup : {hollow_ball(2, 0.3), tube, cone(3, 0.5, 29)}) {
    const Plc plc = build_plc(std::vector{soup});
    const Thickness thickness(plc);
    Thickness::Crossings crossings;
    for (Index t = 0; t < plc.triangles.size(); ++t)
      for (unsigned side = 0; side < 2; ++side) {
        const auto any = thickness.at(t, side, crossings);
        for (const double share : {0.05, 0.3, 0.7}) {
          const double reach = share * plc.bounds.diagonal();
          const auto near = thickness.at(t, side, crossings, reach);
          expect_same_within(reach, any.first, near.first);
          expect_same_within(reach, any.apart, near.apart);
          if (any.first.triangle != none) ++(any.first.distance < reach ? within : beyond);
        }
      }
  }
  EXPECT_GT(within, 0U);
  EXPECT_GT(beyond, 0U);
}

}  // namespace
}  // namespace collarmesh::thin_shells_test
