// Valid input stays as it is. The result of repair does not depend on place, scale, rotation and order.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <functional>

#include "support/acute_shapes.h"
#include "support/repair_shapes.h"
#include "support/shapes.h"

namespace collarmesh::repair_invariance_test {
namespace {

using namespace testing::faulty;

void expect_same_complex(const Plc& a, const Plc& b) {
  ASSERT_EQ(a.points, b.points);
  ASSERT_EQ(a.triangles.size(), b.triangles.size());
  for (std::size_t t = 0; t < a.triangles.size(); ++t) {
    EXPECT_EQ(a.triangles[t].points, b.triangles[t].points);
    EXPECT_EQ(a.triangles[t].patch, b.triangles[t].patch);
  }
  EXPECT_EQ(a.curves.size(), b.curves.size());
  ASSERT_EQ(a.regions.size(), b.regions.size());
  for (std::size_t r = 0; r < a.regions.size(); ++r) EXPECT_EQ(a.regions[r].volume, b.regions[r].volume);
}

void expect_untouched(std::span<const PolygonSoup> soups) {
  const RepairedPlc r = build_repaired_plc(soups);
  EXPECT_FALSE(r.report.repaired);
  EXPECT_TRUE(r.soups.empty());
  EXPECT_TRUE(describe(r.report).empty());
  expect_same_complex(r.plc, build_plc(soups));
}

TEST(RepairInvariance, ValidInputStays) {
  using namespace testing;
  for (const PolygonSoup& soup :
       {box(), box({0, 0, 0}, {1, 2, 3}, 4), l_shape(), regular_prism(7), icosphere(1, 6),
        torus(1, 0.3, 30, 12), cylinder(1, 2, 24, 3), cone(1, 2, 24, 3), spiked_sphere(0.05, 1),
        box_with_cavity(0.3), box_with_small_facet(1e-3), two_boxes(), box_with_dangling_facet(),
        box_with_skew_lines(5), plate_with_hole(1, 24), random_prism(3), random_hull(4, 20),
        faulty::slotted_box(1e-3), faulty::finned_box(1e-3)})
    expect_untouched({&soup, 1});
  for (const auto& soups :
       {touching_boxes(), boxes_touching_in_an_edge(), rings_touching_in_a_circle(), nested_boxes(4)})
    expect_untouched(soups);
  for (std::uint32_t seed = 1; seed <= 3; ++seed)
    for (const acute::Shape& shape : acute::random_members(seed)) {
      SCOPED_TRACE(shape.name);
      expect_untouched(shape.soups);
    }
}

// Valid features below the tolerance are noise.
TEST(RepairInvariance, NoiseInValidInputIsRepaired) {
  for (const PolygonSoup& soup : {slotted_box(1e-7), finned_box(1e-7)}) {
    const RepairedPlc r = build_repaired_plc({&soup, 1});
    EXPECT_TRUE(r.report.repaired);
    RepairOptions off;
    off.mode = RepairMode::off;
    EXPECT_FALSE(build_repaired_plc({&soup, 1}, {}, off).report.repaired);
  }
}

TEST(RepairInvariance, FineValidSphereStays) {
  const PolygonSoup soup = testing::icosphere_of(1, 100000);
  EXPECT_FALSE(build_repaired_plc({&soup, 1}).report.repaired);
}

TEST(RepairInvariance, ModeOffThrowsWhatTheBuilderThrows) {
  const PolygonSoup soup = box_with_wall(0.5, 0.5);
  RepairOptions off;
  off.mode = RepairMode::off;
  EXPECT_THROW(build_repaired_plc({&soup, 1}, {}, off), PlcError);
  PolygonSoup bad = testing::box();
  bad.points[3].y = NAN;
  EXPECT_THROW(build_repaired_plc({&bad, 1}), PlcError);
  EXPECT_THROW(repair({&bad, 1}), PlcError);
}

struct Family {
  const char* name;
  std::function<std::vector<PolygonSoup>(Random&)> make;
  double roughness_of_holes = 0;
};

std::vector<Family> families() {
  using Soups = std::vector<PolygonSoup>;
  const auto cube = [](Random& random) {
    return testing::translated(turned(testing::box({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}, 1), random),
                               0.4 * random_direction(random));
  };
  return {
      {"turned cubes, one soup",
       [=](Random& r) {
         return Soups{joined(std::array{cube(r), cube(r)})};
       }},
      {"turned cubes, two soups",
       [=](Random& r) {
         return Soups{cube(r), cube(r)};
       }},
      {"boxes of a lattice",
       [](Random& r) {
         Soups soups;
         for (const Box& b : random_boxes(r, 3, 3)) soups.push_back(soup_of(b));
         return soups;
       }},
      {"wall",
       [](Random& r) { return Soups{box_with_wall(uniform(r, 0.2, 0.8), uniform(r, 0.3, 0.7), 0.1)}; }},
      {"holes", [](Random& r) { return Soups{jittered(sphere_with_holes(r, 6, 2).soup, r, 0.01)}; }, 0.01},
      {"prism",
       [](Random& r) {
         return Soups{jittered(triangulated(twisted_prism(4, uniform(r, 100, 200), false)), r, 0.1)};
       }},
      {"t-junctions", [](Random& r) { return Soups{box_with_t_junctions(r, 3)}; }},
      {"terrain", [](Random& r) { return Soups{folded_terrain(r, 8, 0.4)}; }}};
}

// The volumes of the regions, by size.
struct Volumes {
  std::vector<double> volumes;
  double bound = 0;  // bound on the change of a volume by repair and by filled holes
};

// Facets that move by a distance change a volume by at most that times their area. Two ways to fill a hole
// differ by at most the roughness of its border.
Volumes volumes_of(std::span<const PolygonSoup> soups, double roughness_of_holes = 0) {
  const RepairedPlc r = repaired(soups);
  Volumes result;
  for (std::size_t i = 1; i < r.plc.regions.size(); ++i) result.volumes.push_back(r.plc.regions[i].volume);
  std::sort(result.volumes.begin(), result.volumes.end());
  const double distance = r.report.largest_distance;
  EXPECT_LE(distance, 3 * r.report.tolerance);
  for (const PolygonSoup& soup : soups) result.bound += distance * area(soup);
  for (const FilledHole& hole : r.report.filled) result.bound += roughness_of_holes * hole.area;
  return result;
}

using Change = std::function<PolygonSoup(const PolygonSoup&)>;

void expect_same_volumes(const Volumes& before, const Volumes& after, double scale) {
  constexpr double rounding = 1e-12;
  const double cube = std::pow(scale, 3);
  ASSERT_EQ(before.volumes.size(), after.volumes.size());
  const double bound = before.bound + after.bound / cube + rounding;
  for (std::size_t i = 0; i < before.volumes.size(); ++i)
    EXPECT_NEAR(after.volumes[i] / cube, before.volumes[i], bound);
}

void expect_invariant(unsigned count, std::uint64_t seed, const Change& change, double scale) {
  for (const Family& family : families()) {
    Random random(seed);
    for (unsigned member = 0; member < members(count); ++member) {
      SCOPED_TRACE(fmt::format("{}, member {}", family.name, member));
      const auto soups = family.make(random);
      std::vector<PolygonSoup> changed;
      for (const PolygonSoup& soup : soups) changed.push_back(change(soup));
      expect_same_volumes(volumes_of(soups, family.roughness_of_holes),
                          volumes_of(changed, scale * family.roughness_of_holes), scale);
    }
  }
}

TEST(RepairInvariance, PowersOfTwoChangeNothing) {
  for (const double scale : {1.0 / 1024, 64.0})
    for (const Family& family : families()) {
      Random random(21);
      for (unsigned member = 0; member < members(2); ++member) {
        SCOPED_TRACE(fmt::format("{}, member {}", family.name, member));
        auto soups = family.make(random);
        std::vector<double> before = volumes_of(soups).volumes;
        for (double& volume : before) volume *= std::pow(scale, 3);
        for (PolygonSoup& soup : soups) soup = testing::scaled(soup, scale);
        EXPECT_EQ(volumes_of(soups).volumes, before);
      }
    }
}

TEST(RepairInvariance, ScaledAndMoved) {
  expect_invariant(
      2, 22, [](const PolygonSoup& soup) { return testing::scaled(soup, 25.4); }, 25.4);
  expect_invariant(
      2, 23,
      [](const PolygonSoup& soup) {
        return testing::translated(soup, {3.1, -7.7, 1.3});
      },
      1);
}

TEST(RepairInvariance, Rotated) {
  expect_invariant(
      2, 24,
      [](const PolygonSoup& soup) {
        return testing::rotated(soup, {1, 2, -1}, 37);
      },
      1);
}

// When boxes are turned, rounding separates their sides in one plane.
TEST(RepairInvariance, RotatedBoxesOfALattice) {
  Random random(24);
  for (unsigned member = 0; member < members(5); ++member) {
    SCOPED_TRACE(member);
    std::vector<PolygonSoup> soups, turned;
    for (const Box& b : random_boxes(random, 3 + member % 3, 3)) {
      soups.push_back(soup_of(b));
      turned.push_back(testing::rotated(soups.back(), {1, 2, -1}, 37 + 11 * member));
    }
    expect_same_volumes(volumes_of(soups), volumes_of(turned), 1);
  }
}

TEST(RepairInvariance, OrderOfPointsFacetsAndCorners) {
  expect_invariant(
      2, 25, [](const PolygonSoup& soup) { return testing::permuted(soup, 5); }, 1);
  Random random(26);
  expect_invariant(
      2, 27, [&](const PolygonSoup& soup) { return corners_rotated(soup, random); }, 1);
}

TEST(RepairInvariance, SameInputSameResult) {
  Random random(28);
  for (const Family& family : families()) {
    const auto soups = family.make(random);
    const RepairedPlc first = repaired(soups), second = repaired(soups);
    expect_same_complex(first.plc, second.plc);
  }
}

// The result of a repair needs no repair.
TEST(RepairInvariance, RepairedSoupsAreValid) {
  Random random(29);
  for (const Family& family : families()) {
    SCOPED_TRACE(family.name);
    const RepairedPlc r = repaired(family.make(random));
    if (r.report.repaired) {
      EXPECT_FALSE(repaired(r.soups).report.repaired);
    }
  }
}

}  // namespace
}  // namespace collarmesh::repair_invariance_test
