// Parts of periodic faces: pairs and their motions, images of features, and tolerances, by brute force over
// the points of the curves.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "collarmesh/error.h"
#include "periodic/feature_images.h"
#include "periodic/motions.h"
#include "periodic/pair_choice.h"
#include "periodic/tolerance_across.h"
#include "support/any_complex.h"
#include "support/shapes.h"

namespace collarmesh::periodic_parts_test {
namespace {

using namespace testing;

constexpr double small = 0.001, large = 0.03, distance = 1e-6;

bool is_at(const Plc& plc, Index triangle, double z) {
  return std::ranges::all_of(plc.triangles[triangle].points,
                             [&](Index p) { return std::fabs(plc.points[p].z - z) < 1e-9; });
}

/// A tolerance that is small in the planar patch at this height.
SurfaceTolerance small_at(const Plc& plc, double z) {
  std::vector<double> triangles;
  for (Index t = 0; t < plc.triangles.size(); ++t) triangles.push_back(is_at(plc, t, z) ? small : large);
  return {plc, std::move(triangles), large};
}

std::vector<Point> points_of_round_curves(const Plc& plc, double z) {
  std::vector<Point> points;
  for (const Plc::Curve& curve : plc.curves)
    for (const Index p : curve.points)
      if (!curve.straight && std::fabs(plc.points[p].z - z) < 1e-9) points.push_back(plc.points[p]);
  return points;
}

TEST(ToleranceAcross, RisesSlowlyFromTheImagesOfCurvesWithASmallerOne) {
  const Plc plc = complex_of(plate_with_hole(1, 24));
  for (const double z : {0.0, 1.0}) {
    const SurfaceTolerance given = small_at(plc, z);
    const SurfaceTolerance made = periodicity::tolerance_across(given, plc, {.pairs = {"z"}}, distance);
    const std::vector<Point> images = points_of_round_curves(plc, 1 - z);
    ASSERT_EQ(images.size(), 24U);
    std::size_t changed = 0;
    for (Index t = 0; t < plc.triangles.size(); ++t) {
      const auto& [a, b, c] = plc.triangles[t].points;
      const Point middle = (plc.points[a] + plc.points[b] + plc.points[c]) / 3;
      double expected = given.at_triangle(t);
      for (const Point& image : images)
        for (const Point& p : {plc.points[a], plc.points[b], plc.points[c], middle})
          expected = std::min(expected, small + 0.1 * norm(p - image));
      EXPECT_NEAR(made.at_triangle(t), expected, 1e-15);
      changed += made.at_triangle(t) < given.at_triangle(t) ? 1 : 0;
    }
    EXPECT_GT(changed, 24U);
    EXPECT_EQ(made.largest(), large);
    for (const Plc::Curve& curve : plc.curves)
      if (!curve.straight) {
        EXPECT_NEAR(made.largest_on_curve(curve), small, 1e-15);
      }
  }
}

TEST(ToleranceAcross, StaysWhereBothSidesHaveTheSame) {
  const Plc plc = complex_of(plate_with_hole(1, 24));
  const PeriodicOptions along_z{.pairs = {"z"}};
  EXPECT_FALSE(periodicity::tolerance_across(SurfaceTolerance(large), plc, along_z, distance).varies());
  std::vector<double> triangles(plc.triangles.size(), large);
  for (Index t = 0; t < plc.triangles.size(); ++t)
    if (is_at(plc, t, 0) || is_at(plc, t, 1)) triangles[t] = small;
  const SurfaceTolerance given(plc, triangles, large);
  const SurfaceTolerance made = periodicity::tolerance_across(given, plc, along_z, distance);
  for (Index t = 0; t < plc.triangles.size(); ++t) EXPECT_EQ(made.at_triangle(t), given.at_triangle(t));
}

// choose_pairs

periodicity::PatchPair pair_of(const std::string& text) {
  return periodicity::choose_pairs({.pairs = {text}}, complex_of(box())).at(0);
}

/// Expects that a motion turns points by an angle about an axis.
void expect_rotation(const TetMesh::Motion& motion, const Point& through, const Vector& direction,
                     double degrees) {
  const Vector axis = direction / norm(direction);
  const double angle = degrees * std::numbers::pi / 180;
  for (const Point& p : {Point{1, 2, 3}, Point{-4, 0.5, 2}, Point{0, 0, 0}}) {
    const Vector arm = p - through, along = dot(arm, axis) * axis, out = arm - along;
    const Point expected = through + along + std::cos(angle) * out + std::sin(angle) * cross(axis, out);
    EXPECT_LT(norm(motion(p) - expected), 1e-12);
    EXPECT_LT(norm(periodicity::inverse(motion)(motion(p)) - p), 1e-12);
  }
}

TEST(PeriodicPairs, RotationsHaveAnyAxisAndAngle) {
  expect_rotation(pair_of("1=2:rotation,z,30").motion, {0, 0, 0}, {0, 0, 1}, 30);
  expect_rotation(pair_of("1=2:rotation,x,-90").motion, {0, 0, 0}, {1, 0, 0}, -90);
  expect_rotation(pair_of("1=2:rotation,1,2,3,0,2,1,72.5").motion, {1, 2, 3}, {0, 2, 1}, 72.5);
  EXPECT_EQ(pair_of("1=2:translation,1,2,3").motion({1, 1, 1}), (Point{2, 3, 4}));
  EXPECT_EQ(pair_of("1=2").motion({0, 0.5, 0.5}), (Point{1, 0.5, 0.5}));
}

std::string refusal(const std::vector<std::string>& pairs, const PolygonSoup& soup,
                    double within = distance) {
  try {
    require_periodic_patches({.pairs = pairs}, complex_of(soup), within);
  } catch (const OptionError& error) {
    return error.what();
  }
  return {};
}

TEST(PeriodicPairs, MistakesAreTold) {
  EXPECT_EQ(refusal({"x", "y", "z"}, box()), "");
  for (const auto& [pairs, says] : std::vector<std::pair<std::vector<std::string>, std::string>>{
           {{"1=2:rotation,0,0,0,0,0,0,30"}, "the direction of the axis is 0 0 0"},
           {{"1=2:shear,1"}, "rotation"},
           {{"1=2:translation,1,2"}, "rotation"},
           {{"x", "3=2"}, "patch 2 is in two groups"},
           {{"1=2:rotation,z,30"}, "has no image on the second patches"}})
    EXPECT_NE(refusal(pairs, box()).find(says), std::string::npos)
        << pairs[0] << ": " << refusal(pairs, box());
  const std::string inside = refusal({"7=1"}, two_boxes());
  EXPECT_NE(inside.find("patch 7 is not on the boundary"), std::string::npos) << inside;
}

TEST(PeriodicPairs, FeaturesWithoutImagesAreTold) {
  PolygonSoup cone = plate_with_hole(1, 24);  // with another radius above
  for (Point& p : cone.points)
    if (p.z == 1 && std::hypot(p.x, p.y) < 1.5) p = {1.25 * p.x, 1.25 * p.y, p.z};
  const std::string curve = refusal({"z"}, cone, 0.1);
  EXPECT_NE(curve.find("the curve through ("), std::string::npos) << curve;
  EXPECT_NE(curve.find("0.354 away"), std::string::npos) << curve << ", the distance of the boxes";
  EXPECT_EQ(refusal({"z"}, cone, 0.26), "") << "within the tolerance";
  const std::string more = refusal({"z"}, box_with_small_facet(0.25));
  EXPECT_NE(more.find("the first patches have 4 vertices, the second 8"), std::string::npos) << more;
}

}  // namespace
}  // namespace collarmesh::periodic_parts_test
