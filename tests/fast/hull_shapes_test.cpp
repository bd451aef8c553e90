// Tets measured in pairs have the same shape as tets measured one by one.
#include "remesh/hull_shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "coarsen/coarsening_rule.h"

namespace collarmesh::hull_shapes_test {
namespace {

using remeshing::Corners;
using remeshing::ExtremeCosines;
using remeshing::HullShapes;

struct Hull {
  std::vector<Point> points;
  std::vector<std::array<Index, 3>> faces;
  Point apex;

  Corners tet(std::size_t face) const {
    const auto& [b, c, d] = faces[face];
    return {apex, points[b], points[c], points[d]};
  }
};

/// Returns faces of any shape: some reversed, some with collinear corners, some with the apex in their plane.
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
  constexpr std::size_t at_once = HullShapes::at_once;
  ASSERT_EQ(shapes.pairs(), (hull.faces.size() + at_once - 1) / at_once);
  for (std::size_t i = 0; i < hull.faces.size(); ++i)
    visit(hull.tet(i), shapes.extreme_cosines(i / at_once, hull.apex)[i % at_once]);
}

TEST(HullShapes, AnglesAreThoseOfEachTet) {
  std::mt19937 random(11);
  unsigned positive = 0, others = 0;
  for (std::size_t k = 0; k < 20000; ++k)
    for_each_tet(any_hull(1 + k % 9, random), [&](const Corners& p, const ExtremeCosines& found) {
      const ExtremeCosines expected = remeshing::extreme_cosines(p);
      const double longest = std::sqrt(std::max(
          {squared_distance(p[0], p[1]), squared_distance(p[0], p[2]), squared_distance(p[0], p[3])}));
      const double six_volume = std::fabs(dot(p[1] - p[0], cross(p[2] - p[0], p[3] - p[0])));
      // If the volume is only rounding errors, its sign is arbitrary.
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

// Qualities are the sines of the extreme angles relative to those of their bounds.
TEST(HullShapes, QualitiesOfCoarseningAreThoseOfTheAngles) {
  std::mt19937 random(12);
  const Plc plc;
  const TetMesh mesh;
  const remeshing::TetBounds bounds{remeshing::ThinShape(plc, mesh, 8, 0, nullptr),
                                    remeshing::CellBounds(plc, mesh, {})};
  const remeshing::Metric metric({});
  remeshing::coarsening::CoarseningRule rule(bounds, 2, metric);
  constexpr std::array<Index, 4> corners{0, 1, 2, 3};
  constexpr double radians = std::numbers::pi / 180;
  std::array<unsigned, 3> seen{};  // without volume, with an angle too large, other
  for (std::size_t k = 0; k < 5000; ++k)
    for_each_tet(any_hull(1 + k % 9, random), [&](const Corners& p, const ExtremeCosines& paired) {
      const auto angles = remeshing::extreme_angles(p);
      ++seen[angles.smallest < 0 ? 0 : angles.largest > 150 ? 1 : 2];
      if (!(angles.smallest > 0.01 && angles.largest < 179.99)) return;
      const double sharp = std::sin(angles.smallest * radians) / std::sin(8 * radians),
                   blunt = angles.largest > 90 ? std::sin(angles.largest * radians) / 0.5 : 2;
      if (std::fabs(blunt - 1) < 1e-5) return;
      using Mode = remeshing::coarsening::CoarseningRule::Mode;
      for (const Mode mode : {Mode::final, Mode::trial, Mode::force}) {
        rule.set_mode(mode);
        const bool last = blunt < 1 && mode != Mode::force;
        const double expected = last ? 1e-6 * blunt * std::min(1.0, sharp) : std::min(blunt, sharp);
        EXPECT_NEAR(rule.quality(p, corners), expected, 1e-5 * expected);
        EXPECT_NEAR(rule.quality_of(paired, p, corners), expected, 1e-5 * expected);
      }
    });
  for (const unsigned count : seen) EXPECT_GT(count, 500U);
}

}  // namespace
}  // namespace collarmesh::hull_shapes_test
