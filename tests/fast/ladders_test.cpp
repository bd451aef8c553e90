// Long narrow strips of smooth surfaces are divided like ladders.
#include "constrained/ladders.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "collarmesh/plc_builder.h"
#include "support/shapes.h"

namespace collarmesh::ladders_test {
namespace {

using namespace testing;

constexpr unsigned strips = 24, pieces = 20;

double volume_of(const Plc& plc) {
  double volume = 0;
  for (const Plc::Triangle& t : plc.triangles) {
    const auto& [a, b, c] = t.points;
    volume += dot(plc.points[a] - Point{}, cross(plc.points[b] - Point{}, plc.points[c] - Point{})) / 6;
  }
  return std::fabs(volume);
}

Plc divided(const Plc& plc, double size, double may_move) {
  return with_ladders(plc, size, [&](Index) { return may_move; });
}

/// Returns a half of the cylinder, cut along its axis, made of triangles.
PolygonSoup half_cylinder() {
  constexpr Index rails = strips / 2 + 1;
  PolygonSoup half;
  for (Index i = 0; i < rails; ++i)
    for (const double z : {0., 1. * pieces}) {
      const double angle = 2 * std::numbers::pi * i / strips;
      half.points.push_back({0.05 * std::cos(angle), 0.05 * std::sin(angle), z});
    }
  const auto add = [&](Index a, Index b, Index c) { half.add_facet(std::vector<Index>{a, b, c}); };
  for (Index i = 0; i < rails; ++i) {
    const Index a = 2 * i, b = 2 * ((i + 1) % rails);  // the last strip is the plane of the cut
    add(a, b, b + 1), add(a, b + 1, a + 1);
    if (i == 0 || i + 1 == rails) continue;
    add(0, b, a), add(1, a + 1, b + 1);
  }
  return half;
}

TEST(Ladders, DivideTheStripsOfACylinder) {
  const Plc plc = build_plc(std::vector{cylinder(0.05, pieces, strips)});
  const Plc ladders = divided(plc, 1, 1e-6);
  EXPECT_EQ(ladders.points.size(), plc.points.size() + strips * (pieces - 1));
  ASSERT_EQ(ladders.patches.size(), plc.patches.size());
  EXPECT_NEAR(volume_of(ladders), volume_of(plc), 1e-12 * volume_of(plc));
  for (Index p = 0; p < plc.patches.size(); ++p) {
    const Plc::Patch& patch = ladders.patches[p];
    EXPECT_EQ(patch.triangle_count,
              plc.patches[p].planar ? plc.patches[p].triangle_count : 2 * strips * pieces);
    for (Index t = patch.first_triangle; t < patch.first_triangle + patch.triangle_count; ++t) {
      const auto& [a, b, c] = ladders.triangles[t].points;
      EXPECT_EQ(ladders.triangles[t].patch, p);
      for (const double length :
           {distance(ladders.points[a], ladders.points[b]), distance(ladders.points[b], ladders.points[c]),
            distance(ladders.points[c], ladders.points[a])})
        EXPECT_LT(length, patch.planar ? 0.2 : 1.01);
    }
  }
}

TEST(Ladders, DivideCurvesAndTheFacesBesideThem) {
  const Plc plc = build_plc(std::vector{half_cylinder()});
  const Plc ladders = divided(plc, 1, 1e-6);
  EXPECT_NEAR(volume_of(ladders), volume_of(plc), 1e-12 * volume_of(plc));
  Index divided_curves = 0;
  for (Index c = 0; c < plc.curves.size(); ++c) {
    const auto &before = plc.curves[c].points, &after = ladders.curves[c].points;
    EXPECT_EQ(before.front(), after.front());
    if (after.size() == before.size()) continue;
    ++divided_curves;
    ASSERT_EQ(after.size(), before.size() + pieces - 1);
    for (std::size_t i = 1; i < after.size(); ++i)
      EXPECT_NEAR(distance(ladders.points[after[i - 1]], ladders.points[after[i]]), 1, 1e-9);
  }
  EXPECT_EQ(divided_curves, 2U);
}

TEST(Ladders, LeaveOtherSurfacesAsTheyAre) {
  const auto is_divided = [](const PolygonSoup& soup, double size) {
    const Plc plc = build_plc(std::vector{soup});
    return divided(plc, size, 1e-6).points != plc.points;
  };
  for (const PolygonSoup& soup : {box(), box({0, 0, 0}, {20, 20, 0.01}), uv_sphere(6, 12, 24)})
    EXPECT_FALSE(is_divided(soup, 2));
  // Strips 3.1 and 7.7 times as long as wide.
  EXPECT_FALSE(is_divided(cylinder(1, 1.2, 16), 0.5));
  EXPECT_TRUE(is_divided(cylinder(1, 3, 16), 0.5));
}

TEST(Ladders, LeaveStripsThatAreASmallPartOfTheSurface) {
  const PolygonSoup rod = cylinder(0.05, pieces, strips);
  const double area_of_rod = 2 * std::numbers::pi * 0.05 * pieces;
  for (const double share : {0.5, 2.0}) {
    const double radius = std::sqrt(share * area_of_rod / (4 * std::numbers::pi));
    const Plc plc = build_plc(std::vector{rod, translated(icosphere(radius, 8), {5, 0, 0})});
    const Plc made = divided(plc, 1, 1e-6);
    EXPECT_EQ(made.points.size() > plc.points.size(), share < 1);
  }
}

}  // namespace
}  // namespace collarmesh::ladders_test
