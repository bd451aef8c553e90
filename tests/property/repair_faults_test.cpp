// Inputs with one kind of fault each, at random; volumes are known or sampled.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "support/meshing.h"
#include "support/repair_shapes.h"
#include "support/shapes.h"

namespace collarmesh::repair_faults_test {
namespace {

using namespace testing::faulty;
using testing::faults;
using testing::mesh_of;
using testing::with_size;
using Strings = std::vector<std::string>;

void expect_sound(const RepairedPlc& r, const PolygonSoup& soup, double reach = 2) {
  EXPECT_EQ(faults_of(r, {&soup, 1}, reach * r.report.tolerance), Strings{});
}

double slack(const RepairedPlc& r, const PolygonSoup& soup) { return r.report.tolerance * area(soup) + 1e-9; }

// Expects the volume found by sampling alone.
void expect_sampled_volume(const RepairedPlc& r, const PolygonSoup& soup, Random& random,
                           unsigned cells = 12) {
  const Sampled sampled = sampled_volume(soup, random, cells);
  EXPECT_NEAR(total_volume(r.plc), sampled.volume, 4 * sampled.deviation + slack(r, soup));
}

TEST(RepairFaults, WallsThroughSidesOfABoxThatEndInside) {
  Random random(1);
  for (unsigned member = 0; member < members(40); ++member) {
    const double share = uniform(random, 0.2, 0.8), overhang = uniform(random, 0.05, 0.3);
    SCOPED_TRACE(fmt::format("member {}: share {}, overhang {}", member, share, overhang));
    const PolygonSoup wall = box_with_wall(uniform(random, 0.1, 0.9), share, overhang);
    const PolygonSoup soup = member < 2 ? wall : turned(wall, random);
    const RepairedPlc r = repaired(soup);
    EXPECT_TRUE(r.report.repaired);
    EXPECT_GT(r.report.cut.count, 0U);
    expect_sound(r, soup);
    EXPECT_NEAR(total_volume(r.plc), 1, slack(r, soup));
    EXPECT_TRUE(r.report.filled.empty());
    if (member < 4) {
      EXPECT_EQ(faults(mesh_of(r.plc, with_size(0.3))), "");
    }
  }
}

TEST(RepairFaults, TwistedPrisms) {
  Random random(3);
  for (unsigned member = 0; member < members(40); ++member) {
    const auto k = static_cast<unsigned>(3 + random() % 5);
    const double degrees = uniform(random, 20, 240);
    const PolygonSoup soup = jittered(triangulated(twisted_prism(k, degrees, false)), random, 0.1);
    SCOPED_TRACE(fmt::format("member {}: {} sides, {} degrees", member, k, degrees));
    const RepairedPlc r = repaired(soup);
    expect_sound(r, soup);
    if (r.report.repaired) expect_sampled_volume(r, soup, random);
    if (member < 4) {
      EXPECT_EQ(faults(mesh_of(r.plc, with_size(0.4))), "");
    }
  }
}

TEST(RepairFaults, QuadranglesThatAreNotPlanar) {
  Random random(4);
  for (unsigned member = 0; member < members(30); ++member) {
    const auto k = static_cast<unsigned>(3 + random() % 5);
    const double degrees = uniform(random, 5, 40);
    const PolygonSoup soup = twisted_prism(k, degrees, true);
    SCOPED_TRACE(fmt::format("member {}: {} sides, {} degrees", member, k, degrees));
    const RepairedPlc r = repaired(soup);
    EXPECT_TRUE(r.report.repaired);
    EXPECT_EQ(r.report.split_polygons, k);
    // The diagonals of all quadrangles are cut one way, or all the other way.
    const double one = signed_volume(twisted_prism(k, degrees, false)),
                 other = signed_volume(twisted_prism(k, -degrees, false));
    EXPECT_GE(total_volume(r.plc), std::min(one, other) - slack(r, soup));
    EXPECT_LE(total_volume(r.plc), std::max(one, other) + slack(r, soup));
    if (member < 3) {
      EXPECT_EQ(faults(mesh_of(r.plc, with_size(0.4))), "");
    }
  }
}

// A solid with a cavity, however its two surfaces are oriented; a solid in a solid stays two regions.
TEST(RepairFaults, NestedShellsTurnedWrong) {
  for (const double inner : {0.3, 0.7})
    for (const bool outer_inverted : {false, true})
      for (const bool inner_inverted : {false, true}) {
        SCOPED_TRACE(fmt::format("inner {}, outer {}, inner {}", inner, outer_inverted, inner_inverted));
        const PolygonSoup soup = nested_spheres(inner, outer_inverted, inner_inverted);
        const double large = signed_volume(nested_spheres(inner, false, false)) -
                             signed_volume(testing::icosphere(inner, 2)),
                     small = signed_volume(testing::icosphere(inner, 2));
        const RepairResult r = repair({&soup, 1});
        // Parts inside a reversed component are reversed with it.
        const bool cavity = outer_inverted != inner_inverted;
        EXPECT_EQ(r.report.turned.count, outer_inverted ? 2U : 0U);
        const Plc plc = build_plc(r.soups);
        // Winding numbers decide only about tangled parts; clean surfaces stay.
        EXPECT_NEAR(total_volume(plc), cavity ? large - small : large, 1e-9);
        EXPECT_EQ(plc.regions.size(), cavity ? 2U : 3U);
        // For the builder none of this is a fault.
        EXPECT_FALSE(repaired(soup).report.repaired);
      }
}

TEST(RepairFaults, HolesInASphereAreFilled) {
  Random random(6);
  for (unsigned member = 0; member < members(30); ++member) {
    const auto frequency = static_cast<unsigned>(8 + random() % 3);
    const OpenSphere open = sphere_with_holes(random, frequency, 1 + member % 5);
    SCOPED_TRACE(fmt::format("member {}: frequency {}, {} holes", member, frequency, open.holes.size()));
    const RepairedPlc r = repaired(open.soup);
    EXPECT_TRUE(r.report.repaired);
    expect_sound(r, open.soup);
    const PolygonSoup sphere = testing::icosphere(1, frequency);
    ASSERT_EQ(r.report.filled.size(), open.holes.size());
    std::vector<bool> found(open.holes.size(), false);
    double caps = 0;
    for (const FilledHole& hole : r.report.filled) {
      for (std::size_t i = 0; i < open.holes.size(); ++i)
        if (distance(hole.where, open.holes[i]) < 1.5 / frequency) {
          EXPECT_EQ(hole.edges, open.edges[i]);
          found[i] = true;
        }
      EXPECT_GT(hole.tag, 1);
      // The filling's area is about that of the disk whose circle is as long as the hole's border. All
      // fillings together have at most the area of the facets that were removed.
      EXPECT_GT(hole.length, 0);
      const double radius = hole.length / (2 * std::numbers::pi);
      EXPECT_LT(hole.area, 1.01 * std::numbers::pi * radius * radius);
      EXPECT_GT(hole.area, 0.7 * std::numbers::pi * radius * radius);
      caps += hole.area;
    }
    EXPECT_EQ(std::count(found.begin(), found.end(), true), static_cast<std::ptrdiff_t>(found.size()));
    EXPECT_LE(area(open.soup) + caps, area(sphere) + 1e-9);
    // Each cap loses less than a cone as high as two rings of facets are deep.
    const double depth = 1 - std::cos(1.5 / frequency);
    EXPECT_LT(total_volume(r.plc), signed_volume(sphere));
    EXPECT_GT(total_volume(r.plc), signed_volume(sphere) - caps * depth);
    EXPECT_EQ(r.plc.regions.size(), 2U);
    if (member < 2) {
      EXPECT_EQ(faults(mesh_of(r.plc, with_size(0.4))), "");
    }
  }
}

TEST(RepairFaults, RepeatedAndInvertedFacets) {
  Random random(7);
  for (unsigned member = 0; member < members(40); ++member) {
    SCOPED_TRACE(member);
    const PolygonSoup sound =
        member % 2 == 0 ? testing::icosphere(1, 3) : triangulated(testing::box({0, 0, 0}, {1, 1, 1}, 3));
    const auto count = static_cast<unsigned>(1 + random() % 6);
    const bool same_way = member % 4 < 2;
    PolygonSoup soup = with_repeated_facets(sound, random, count, !same_way);
    if (member % 3 == 0) soup = with_inverted_facets(soup, random, 3);
    const RepairedPlc r = repaired(soup);
    expect_sound(r, soup);
    EXPECT_NEAR(total_volume(r.plc), signed_volume(sound), slack(r, soup));
    EXPECT_EQ(r.plc.regions.size(), 2U);
    const RepairResult direct = repair({&soup, 1});
    if (same_way && member % 3 != 0) {
      EXPECT_EQ(direct.report.repeated.count, count);
    }
    EXPECT_NEAR(total_volume(build_plc(direct.soups)), signed_volume(sound), slack(r, soup));
  }
}

TEST(RepairFaults, TJunctionsAreClosed) {
  Random random(8);
  for (unsigned member = 0; member < members(30); ++member) {
    SCOPED_TRACE(member);
    const PolygonSoup soup =
        turned(box_with_t_junctions(random, static_cast<unsigned>(2 + random() % 4)), random);
    const RepairedPlc r = repaired(soup);
    expect_sound(r, soup);
    EXPECT_NEAR(total_volume(r.plc), 1, slack(r, soup));
    EXPECT_EQ(r.plc.regions.size(), 2U);
    EXPECT_TRUE(r.report.filled.empty());
    if (member < 3) {
      EXPECT_EQ(faults(mesh_of(r.plc, with_size(0.3))), "");
    }
  }
}

// Slots and fins: those thinner than the tolerance vanish, everything else stays.
TEST(RepairFaults, ThinFeaturesVanishBelowTheTolerance) {
  Random random(9);
  struct Family {
    const char* name;
    PolygonSoup (*make)(double);
    double sign, share;  // share: of the width or its square
    bool squared;
  };
  for (const Family& family : {Family{"slot", slotted_box, -0.5, 1, false},
                               {"fin", finned_box, 0.5, 1, false},
                               {"spike", spiked_box, 0.5 / 3, 1, true}})
    for (double width = 1e-3; width > 5e-10; width /= std::sqrt(10.0))
      for (unsigned member = 0; member < members(2); ++member) {
        SCOPED_TRACE(fmt::format("{} of width {}, member {}", family.name, width, member));
        PolygonSoup soup = triangulated(family.make(width));
        if (family.make != spiked_box) soup = family.make(width);
        if (member > 0) soup = turned(soup, random);
        const RepairResult r = repair({&soup, 1});
        Plc plc;
        try {
          plc = build_plc(r.soups);
        } catch (const Error& error) {
          ADD_FAILURE() << error.what();
          continue;
        }
        const double feature = family.sign * (family.squared ? width * width : width);
        const double tolerance = r.report.tolerance;
        const double actual = total_volume(plc);
        EXPECT_EQ(plc.regions.size(), 2U);
        EXPECT_EQ(faults_of({plc, r.report, r.soups}, {&soup, 1}, 3 * tolerance), Strings{});
        if (width > 3 * tolerance) {
          EXPECT_NEAR(actual, 1 + feature, 2 * tolerance * tolerance + 1e-9);
        } else if (width < 0.5 * tolerance) {
          EXPECT_NEAR(actual, 1, tolerance * area(soup));
          // Closer points are merged from the start.
          if (width > 4e-9) {
            EXPECT_GT(r.report.collapsed.count, 0U);
          }
          double top = -INFINITY;
          if (family.make == finned_box && member == 0) {
            for (const PolygonSoup& s : r.soups)
              for (Index q = 0; q < s.polygon_count(); ++q)
                for (const Index p : s.polygon(q)) top = std::max(top, s.points[p].y);
            EXPECT_LE(top, 1 + 2 * tolerance);
          }
        }
      }
}

TEST(RepairFaults, TerrainFoldedThroughItself) {
  Random random(10);
  for (unsigned member = 0; member < members(16); ++member) {
    const double fold = uniform(random, 0.15, 0.5);
    const PolygonSoup soup = folded_terrain(random, 8 + static_cast<unsigned>(random() % 5), fold);
    SCOPED_TRACE(fmt::format("member {}: fold {}", member, fold));
    const RepairedPlc r = repaired(soup);
    expect_sound(r, soup);
    if (r.report.repaired) expect_sampled_volume(r, soup, random, 10);
    if (member == 0) {
      EXPECT_EQ(faults(mesh_of(r.plc, with_size(0.4))), "");
    }
  }
}

// Far from the origin, with 32-bit coordinates, points move by 6e-5 of the diagonal.
TEST(RepairFaults, CoordinatesOf32BitsFarAway) {
  Random random(11);
  for (unsigned member = 0; member < members(24); ++member) {
    SCOPED_TRACE(member);
    PolygonSoup soup;
    if (member % 3 == 0)
      soup = turned(testing::icosphere(1, 4), random);
    else if (member % 3 == 1)
      soup = triangulated(turned(testing::box({0, 0, 0}, {1, 1, 1}, 4), random));
    else
      soup =
          joined(std::array{turned(testing::icosphere(1, 2), random),
                            testing::translated(turned(testing::icosphere(0.8, 3), random), {0.7, 0.2, 0})});
    const double diagonal = bounds({&soup, 1}).diagonal();
    const PolygonSoup rounded = in_single_precision(soup, 1000 * diagonal * random_direction(random));
    const RepairedPlc r = repaired(rounded);
    const double unit = 6e-8 * 1000 * diagonal;
    EXPECT_EQ(faults_of(r, {&rounded, 1}, std::max(2 * r.report.tolerance, unit)), Strings{});
    EXPECT_EQ(r.plc.regions.size(), 2U);
    if (member % 3 < 2) {
      EXPECT_NEAR(total_volume(r.plc), signed_volume(soup), (unit + r.report.tolerance) * area(soup));
    } else {
      expect_sampled_volume(r, rounded, random, 10);
    }
  }
}

}  // namespace
}  // namespace collarmesh::repair_faults_test
