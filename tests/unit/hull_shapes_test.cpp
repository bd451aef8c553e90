// Tets that are measured in pairs have the shape that they have one by one.
#include "improve/hull_shapes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "coarsen/coarsening_rule.h"
#include "improve/shape_rule.h"

namespace collarmesh {
namespace {

using improvement::Corners;
using improvement::ExtremeCosines;
using improvement::HullShapes;

struct Hull {
  std::vector<Point> points;
  std::vector<std::array<Index, 3>> faces;
  Point apex;

  Corners tet(std::size_t face) const {
    const auto& [b, c, d] = faces[face];
    return {apex, points[b], points[c], points[d]};
  }
};

/// Faces of any shape, some of them turned the other way, some with corners in line or with the apex in their
/// plane.
Hull any_hull(std::size_t size, std::mt19937& random) {
  std::normal_distribution<double> normal;
  const double scale = std::pow(10, std::uniform_int_distribution(-20, 20)(random)),
               flatness = std::pow(10, std::uniform_real_distribution(-4.0, 0.0)(random));
  const auto point = [&] { return scale * Point{normal(random), normal(random), flatness * normal(random)}; };
  Hull hull{{}, {}, point()};
  for (std::size_t i = 0; i < size; ++i) {
    const auto first = static_cast<Index>(hull.points.size());
    hull.points.insert(hull.points.end(), {point(), point(), point()});
    if (i % 7 == 3) hull.points.back() = hull.apex + 2 * (hull.points[first] - hull.apex);
    if (i % 7 == 5) hull.points.back() = hull.points[first];
    hull.faces.push_back({first, first + 1, first + 2});
  }
  return hull;
}

template <class Visit>
void for_each_tet(const Hull& hull, const Visit& visit) {
  HullShapes shapes;
  EXPECT_TRUE(shapes.empty());
  shapes.assign(hull.faces, hull.points);
  ASSERT_EQ(shapes.pairs(), (hull.faces.size() + 1) / 2);
  for (std::size_t i = 0; i < hull.faces.size(); ++i)
    visit(hull.tet(i), shapes.extreme_cosines(i / 2, hull.apex)[i % 2]);
}

TEST(HullShapes, AnglesAreThoseOfEachTet) {
  std::mt19937 random(11);
  unsigned positive = 0, others = 0;
  for (std::size_t k = 0; k < 20000; ++k)
    for_each_tet(any_hull(1 + k % 9, random), [&](const Corners& p, const ExtremeCosines& found) {
      const ExtremeCosines expected = improvement::extreme_cosines(p);
      const double longest = std::sqrt(std::max(squared_distance(p[0], p[1]), squared_distance(p[0], p[2])));
      const double six_volume = std::fabs(dot(p[1] - p[0], cross(p[2] - p[0], p[3] - p[0])));
      // A volume of rounding errors has no sign.
      if (six_volume > 1e-12 * longest * longest * longest) {
        EXPECT_EQ(found.positive, expected.positive);
      }
      if (!found.positive || !expected.positive) return void(++others);
      ++positive;
      const double rounding = 1e-9 + 1e-14 * longest * longest * longest / six_volume;
      EXPECT_NEAR(found.smallest_angle, expected.smallest_angle, rounding);
      EXPECT_NEAR(found.largest_angle, expected.largest_angle, rounding);
    });
  EXPECT_GT(positive, 20000U);
  EXPECT_GT(others, 20000U);
}

TEST(HullShapes, RulesFindTheSameQualityByAngles) {
  std::mt19937 random(12);
  const Plc plc;
  const TetMesh mesh;
  const improvement::ThinShape thin(plc, mesh, 8);
  const std::vector<double> sizes;
  using Mode = coarsening::CoarseningRule::Mode;
  const improvement::ThinRule thin_rule(thin);
  coarsening::CoarseningRule coarse(thin, 2, sizes);
  constexpr std::array<Index, 4> corners{0, 1, 2, 3};
  std::array<unsigned, 3> seen{};  // of negative quality, with an angle too large, good
  for (std::size_t k = 0; k < 5000; ++k)
    for_each_tet(any_hull(1 + k % 9, random), [&](const Corners& p, const ExtremeCosines&) {
      const ExtremeCosines cosines = improvement::extreme_cosines(p);
      const auto expect_same = [&](const improvement::ShapeRule& rule) {
        ASSERT_TRUE(rule.by_angles());
        EXPECT_EQ(rule.quality(cosines, corners), rule.quality(p, corners));
      };
      expect_same(thin_rule);
      for (const Mode mode : {Mode::final, Mode::trial, Mode::force}) {
        coarse.set_mode(mode);
        expect_same(coarse);
      }
      coarse.set_mode(Mode::final);
      const double quality = coarse.quality(p, corners);
      // Its definition: the sines of the extreme angles over those of their bounds.
      const auto angles = improvement::extreme_angles(p);
      ++seen[quality < 0 ? 0 : angles.largest > 150 ? 1 : 2];
      if (quality < 0 || !(angles.smallest > 0.01 && angles.largest < 179.99)) return;
      const double radians = std::acos(-1) / 180,
                   sharp = std::sin(angles.smallest * radians) / std::sin(8 * radians),
                   blunt = angles.largest > 90 ? std::sin(angles.largest * radians) / 0.5 : 2;
      if (std::fabs(blunt - 1) < 1e-5) return;
      EXPECT_NEAR(quality, blunt < 1 ? 1e-6 * blunt * std::min(1.0, sharp) : std::min(blunt, sharp),
                  1e-5 * quality);
    });
  for (const unsigned count : seen) EXPECT_GT(count, 500U);
}

}  // namespace
}  // namespace collarmesh
