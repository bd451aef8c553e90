#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>
#include <random>

#include "collarmesh/plc_builder.h"
#include "support/plc_shapes.h"

namespace collarmesh::plc_invariance_test {
namespace {

using testing::findings;

struct Counts {
  Index vertices, curves, straight_curves, patches, planar_patches, regions;
  std::size_t creases;
  friend bool operator==(const Counts&, const Counts&) = default;
};
Counts counts(const Plc& plc) {
  const PlcSummary s = summarize(plc);
  return {s.vertices, s.curves, s.straight_curves, s.patches, s.planar_patches, s.regions, s.creases.size()};
}

std::vector<double> sorted_volumes(const Plc& plc) {
  std::vector<double> volumes;
  for (std::size_t r = 1; r < plc.regions.size(); ++r) volumes.push_back(plc.regions[r].volume);
  std::sort(volumes.begin(), volumes.end());
  return volumes;
}

std::vector<PolygonSoup> shapes() {
  using namespace testing;
  return {polygonal_box({0, 0, 0}, {1, 2, 3}),
          subdivided_box({-1, 0, 0}, {1, 1, 1}, 5),
          polygonal_cylinder(50, 1, 2),
          polygonal_cone(64, 50, 1),
          wedge(35, 1),
          sphere(6, 1, {0, 0, 0}),
          joined({polygonal_box({0, 0, 0}, {3, 3, 3}), reversed(polygonal_box({1, 1, 1}, {2, 2, 2})),
                  polygonal_box({4, 0, 0}, {5, 1, 1})}),
          joined({polygonal_box({0, 0, 0}, {1, 1, 1}), polygonal_box({1, 1, 0}, {2, 2, 1}),
                  sphere(5, 0.4, {5, 5, 5})})};
}

TEST(PlcInvariance, MovingScalingAndShufflingChangeNothing) {
  for (const PolygonSoup& shape : shapes()) {
    const Plc reference = build_plc({&shape, 1});
    const Counts expected = counts(reference);
    const auto volumes = sorted_volumes(reference);
    for (std::uint64_t seed = 1; seed <= 6; ++seed)
      for (const double scale : {1e-6, 1.0, 1e6}) {
        const PolygonSoup soup =
            testing::shuffled(testing::moved(shape, seed, scale, 10 * scale), seed, false);
        const Plc plc = build_plc({&soup, 1});
        EXPECT_EQ(findings(plc), std::vector<std::string>{});
        EXPECT_EQ(counts(plc), expected);
        const auto actual = sorted_volumes(plc);
        for (std::size_t r = 0; r < volumes.size(); ++r)
          EXPECT_NEAR(actual[r], volumes[r] * scale * scale * scale,
                      1e-9 * volumes[r] * scale * scale * scale);
      }
  }
}

TEST(PlcInvariance, SameInputSameComplex) {
  const PolygonSoup soup = testing::torn_apart(testing::polygonal_cylinder(30, 1, 2));
  const Plc first = build_plc({&soup, 1}), second = build_plc({&soup, 1});
  ASSERT_EQ(first.points.size(), second.points.size());
  EXPECT_EQ(std::memcmp(first.points.data(), second.points.data(), first.points.size() * sizeof(Point)), 0);
  ASSERT_EQ(first.triangles.size(), second.triangles.size());
  for (std::size_t t = 0; t < first.triangles.size(); ++t)
    EXPECT_EQ(first.triangles[t].points, second.triangles[t].points);
}

// Grids of boxes with common walls, some boxes missing: every box that exists is one region.
TEST(PlcInvariance, RandomGridsOfBoxesHaveOneRegionEach) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    std::mt19937_64 random(seed);
    std::vector<PolygonSoup> soups;
    for (int x = 0; x < 3; ++x)
      for (int y = 0; y < 3; ++y)
        for (int z = 0; z < 3; ++z) {
          if (random() % 3 == 0) continue;
          const Point at{static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)};
          soups.push_back(
              testing::shuffled(testing::subdivided_box(at, at + Point{1, 1, 1}, 1), random(), false));
        }
    const auto apart = build_plc(soups);
    EXPECT_EQ(findings(apart), std::vector<std::string>{});
    ASSERT_EQ(apart.regions.size(), soups.size() + 1);
    for (std::size_t r = 1; r < apart.regions.size(); ++r) EXPECT_NEAR(apart.regions[r].volume, 1, 1e-12);
  }
}

// A star-shaped polygon with star-shaped holes, cut into triangles as a facet; the area is known.
TEST(PlcInvariance, RandomPolygonsWithHolesKeepTheirArea) {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> unit(0, 1);
    PolygonSoup soup;
    soup.begin_facet();
    double expected = 0;
    const auto ring = [&](const Point& centre, double smallest, double largest) {
      const auto n = static_cast<Index>(12 + random() % 30);
      const auto first = static_cast<Index>(soup.points.size());
      std::vector<Index> corners;
      for (Index i = 0; i < n; ++i) {
        const double t = 2 * std::numbers::pi * (i + 0.8 * unit(random)) / n,
                     r = smallest + (largest - smallest) * unit(random);
        corners.push_back(static_cast<Index>(soup.points.size()));
        soup.points.push_back(centre + r * Point{std::cos(t), std::sin(t), 0});
      }
      double twice = 0;
      for (Index i = 0; i < n; ++i) {
        const Point a = soup.points[first + i] - centre, b = soup.points[first + (i + 1) % n] - centre;
        twice += a.x * b.y - a.y * b.x;
      }
      soup.add_polygon(corners);
      return twice / 2;
    };
    expected = ring({0, 0, 0}, 10, 14);
    for (const Point& centre : {Point{4, 4, 0}, Point{-4, 4, 0}, Point{0, -4, 0}}) {
      const double hole = ring(centre, 1, 2);
      soup.facet_holes.push_back({0, centre});
      expected -= hole;
    }
    PlcOptions options;
    options.require_solid = false;
    const PolygonSoup turned = testing::moved(soup, seed, 1, 20);
    Plc plc;
    try {
      plc = build_plc({&turned, 1}, options);
    } catch (const PlcError& error) {
      FAIL() << seed << ": " << error.what();
    }
    EXPECT_EQ(findings(plc), std::vector<std::string>{});
    double actual = 0;
    for (const auto& t : plc.triangles)
      actual += norm(cross(plc.points[t.points[1]] - plc.points[t.points[0]],
                           plc.points[t.points[2]] - plc.points[t.points[0]])) /
                2;
    EXPECT_NEAR(actual, expected, 1e-9 * expected) << seed;
    ASSERT_EQ(plc.patches.size(), 1U);
    EXPECT_TRUE(plc.patches[0].planar);
  }
}

TEST(PlcInvariance, DisjointSpheresNeverIntersectAndCrossingOnesAlwaysDo) {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> unit(0, 1);
    const double gap = 0.02 + unit(random);
    const PolygonSoup first = testing::moved(testing::sphere(6, 1, {0, 0, 0}), seed, 1, 0);
    const auto beside = [&](double d) { return testing::joined({first, testing::sphere(5, 1, {d, 0, 0})}); };
    const PolygonSoup apart = beside(2 + gap), crossing = beside(0.5 + unit(random));
    EXPECT_EQ(build_plc({&apart, 1}).regions.size(), 3U);
    EXPECT_THROW(build_plc({&crossing, 1}), PlcError);
  }
}

}  // namespace
}  // namespace collarmesh::plc_invariance_test
