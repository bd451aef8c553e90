// The quick answers given for most tets without divisions must be correct.
#include "remesh/shape_rule.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "coarsen/coarsening_rule.h"

namespace collarmesh::shape_rules_test {
namespace {

using remeshing::Corners;

/// Returns tets from regular to flat and needle-like, at many scales, some inverted.
Corners any_tet(std::mt19937& random) {
  std::normal_distribution<double> normal;
  const auto point = [&] { return Point{normal(random), normal(random), normal(random)}; };
  Corners p{point(), point(), point(), point()};
  if (std::uniform_int_distribution(0, 2)(random) > 0) {
    const double height = std::pow(10, std::uniform_real_distribution(-3.0, 0.0)(random));
    p[3] = p[0] + 0.3 * (p[1] - p[0]) + 0.4 * (p[2] - p[0]) - height * cross(p[1] - p[0], p[2] - p[0]);
  }
  const double scale = std::pow(10, std::uniform_int_distribution(-20, 20)(random));
  for (Point& corner : p) corner = scale * corner;
  return p;
}

double squared_cosine(double degrees) { return std::pow(std::cos(degrees * std::numbers::pi / 180), 2); }

TEST(ShapeRules, AnglesThatAreSurelyBetweenAreBetween) {
  std::mt19937 random(5);
  unsigned sure = 0, between = 0;
  for (unsigned i = 0; i < 200000; ++i) {
    const Corners p = any_tet(random);
    const double smallest = std::uniform_real_distribution(1.0, 60.0)(random),
                 largest = std::uniform_real_distribution(95.0, 175.0)(random);
    const auto angles = remeshing::extreme_angles(p);
    const bool is_between = angles.smallest > smallest && angles.largest < largest;
    const bool surely = remeshing::surely_between(p, squared_cosine(smallest), squared_cosine(largest));
    EXPECT_TRUE(is_between || !surely)
        << smallest << ' ' << angles.smallest << ' ' << largest << ' ' << angles.largest;
    sure += surely ? 1 : 0;
    between += is_between ? 1 : 0;
  }
  EXPECT_GT(sure, 5000U);
  EXPECT_GE(between, sure);
  EXPECT_LE(between - sure, 2U);  // number of tets that are too close to call
}

TEST(ShapeRules, WhatSurelyExceedsAQualityExceedsIt) {
  std::mt19937 random(6);
  const Plc plc;
  const TetMesh mesh;
  const remeshing::CellBounds cells(plc, mesh, {});
  const remeshing::TetBounds bounds{remeshing::ThinShape(plc, mesh, 8, 0, nullptr), cells},
      with_reserve{remeshing::ThinShape(plc, mesh, 8, 0.05, nullptr), cells};
  const remeshing::SliverRule with_thin(2, &bounds.thin), without(2);
  const remeshing::Metric metric({});
  const remeshing::coarsening::CoarseningRule coarse(bounds, 2, metric),
      coarse_with_reserve(with_reserve, 2, metric);
  constexpr std::array<Index, 4> corners{0, 1, 2, 3};
  std::array<unsigned, 4> sure{};
  for (unsigned i = 0; i < 200000; ++i) {
    const Corners p = any_tet(random);
    const double wanted =
                     std::sin(std::uniform_real_distribution(5.0, 40.0)(random) * std::numbers::pi / 180),
                 above = std::uniform_real_distribution(1.0, 1.6)(random);
    const auto expect = [&](std::size_t rule, bool surely, double quality, double bound) {
      EXPECT_TRUE(quality > bound || !surely) << rule << ' ' << quality << ' ' << bound;
      sure[rule] += surely ? 1 : 0;
    };
    expect(0, with_thin.surely_exceeds(wanted, p), with_thin.quality(p, corners), wanted);
    expect(1, without.surely_exceeds(wanted, p), without.quality(p, corners), wanted);
    expect(2, coarse.surely_exceeds(above, p, corners), coarse.quality(p, corners), above);
    expect(3, coarse_with_reserve.surely_exceeds(above, p, corners), coarse_with_reserve.quality(p, corners),
           above);
  }
  for (const unsigned count : sure) EXPECT_GT(count, 10000U);
}

TEST(ShapeRules, TheQualityIfAllowedIsTheQualityIfTheTetIsAllowed) {
  std::mt19937 random(7);
  const Plc plc;
  const TetMesh mesh;
  const remeshing::ThinShape thin(plc, mesh, 8, 0, nullptr);
  const remeshing::SliverRule with_thin(2, &thin), without(2);
  constexpr std::array<Index, 4> corners{0, 1, 2, 3};
  std::array<unsigned, 2> allowed{}, refused{};
  for (unsigned i = 0; i < 20000; ++i) {
    const Corners p = any_tet(random);
    const double above = std::uniform_real_distribution(-1.0, 0.5)(random);
    const auto expect = [&](std::size_t which, const remeshing::ShapeRule& rule) {
      const double quality = rule.quality(p, corners);
      const bool may_be = quality > above && rule.allows(p, corners, quality);
      EXPECT_EQ(rule.quality_if_allowed(p, corners, above), may_be ? quality : -1);
      ++(may_be ? allowed : refused)[which];
    };
    expect(0, with_thin);
    expect(1, without);
  }
  for (const auto& counts : {allowed, refused})
    for (const unsigned count : counts) EXPECT_GT(count, 1000U);
}

}  // namespace
}  // namespace collarmesh::shape_rules_test
