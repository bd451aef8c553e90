// The measures and searches that the certificate rests on.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "check/mesh_to_check.h"
#include "check/polyline.h"
#include "collarmesh/plc_builder.h"
#include "collarmesh/tet_mesh.h"
#include "common/distance_tree.h"
#include "mesh/orientation.h"
#include "support/shapes.h"

namespace collarmesh::check_parts_test {
namespace {

using namespace collarmesh::checks;

const double regular_dihedral = std::acos(1.0 / 3) * 180 / 3.14159265358979323846;

TEST(Measure, EveryScale) {
  const std::array<Point, 4> t{{{0, 0, 0}, {1.5, 0.25, 0}, {0.25, 1, 0.125}, {0.5, 0.5, 2}}};
  const TetQuality q = measure(t[0], t[1], t[2], t[3]);
  for (const int exponent : {-300, -100, -40, 40, 100, 300}) {
    const double s = std::ldexp(1, exponent);
    const TetQuality scaled = measure(s * t[0], s * t[1], s * t[2], s * t[3]);
    EXPECT_EQ(scaled.volume, std::ldexp(q.volume, 3 * exponent));
    EXPECT_EQ(scaled.radius_edge, q.radius_edge);
    EXPECT_EQ(scaled.min_dihedral, q.min_dihedral);
    EXPECT_EQ(scaled.max_dihedral, q.max_dihedral);
  }
}

TEST(Measure, RegularTet) {
  const TetQuality q = measure({1, 1, 1}, {-1, 1, -1}, {1, -1, -1}, {-1, -1, 1});
  EXPECT_NEAR(q.volume, 8.0 / 3, 1e-14);
  EXPECT_NEAR(q.radius_edge, std::sqrt(6.0) / 4, 1e-15);
  EXPECT_NEAR(q.min_dihedral, regular_dihedral, 1e-12);
  EXPECT_NEAR(q.max_dihedral, regular_dihedral, 1e-12);
}

TEST(Measure, CornerOfACube) {
  const TetQuality q = measure({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1});
  EXPECT_NEAR(q.volume, 1.0 / 6, 1e-16);
  EXPECT_NEAR(q.radius_edge, std::sqrt(3.0) / 2, 1e-15);
  EXPECT_NEAR(q.min_dihedral, std::acos(1 / std::sqrt(3.0)) * 180 / M_PI, 1e-12);
  EXPECT_NEAR(q.max_dihedral, 90, 1e-12);
}

TEST(Measure, InvertedAndFlat) {
  EXPECT_LT(measure({0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {0, 0, 1}).volume, 0);
  const TetQuality flat = measure({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});
  EXPECT_EQ(flat.volume, 0);
  EXPECT_TRUE(std::isinf(flat.radius_edge));
  EXPECT_EQ(flat.min_dihedral, 0);
  EXPECT_EQ(flat.max_dihedral, 180);
}

// Two long edges cross at a small distance: the sphere is known, and the angles are near 0 and 180.
TEST(Measure, SliverKeepsItsDigits) {
  for (const double h : {1e-3, 1e-6, 1e-9}) {
    const Point a{1, 0, -h}, b{-1, 0, -h}, c{0, 1, h}, d{0, -1, h};
    const TetQuality q = measure(a, c, b, d);  // the sphere is centred at the origin
    const double radius = std::hypot(1.0, h), shortest = std::hypot(std::sqrt(2.0), 2 * h);
    EXPECT_NEAR(q.radius_edge / (radius / shortest), 1, 1e-8) << h;
    EXPECT_NEAR(std::fabs(q.volume) / (4 * 2 * h / 6), 1, 1e-12) << h;
    const double steep = std::atan2(2 * h, 1.0) * 2;  // 180 degrees minus the angle at the long edges
    EXPECT_NEAR((180 - q.max_dihedral) * M_PI / 180 / steep, 1, 1e-2 + h) << h;
    EXPECT_GT(q.max_dihedral, 179);
  }
}

TEST(Measure, DoesNotDependOnPlaceScaleAndOrder) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int trial = 0; trial < 200; ++trial) {
    std::array<Point, 4> p;
    for (Point& q : p) q = {unit(random), unit(random), 1e-3 * unit(random)};
    const TetQuality q = measure(p[0], p[1], p[2], p[3]);
    const TetQuality turned = measure(p[2], p[0], p[1], p[3]);
    EXPECT_NEAR(turned.radius_edge / q.radius_edge, 1, 1e-9);
    EXPECT_NEAR(turned.max_dihedral, q.max_dihedral, 1e-9);
    std::array<Point, 4> far;
    for (int i = 0; i < 4; ++i) far[i] = 0x1p40 * p[i];
    EXPECT_NEAR(measure(far[0], far[1], far[2], far[3]).radius_edge / q.radius_edge, 1, 1e-12);
  }
}

TEST(ExactOrientation, DecidesBelowRounding) {
  const double u = 0x1p-52;
  const Point a{0.5, 0.5, 0.5}, b{12, 12, 12}, c{24, 24, 24};
  EXPECT_EQ(exact_orientation(a, b, c, {1, 2, 3}), 0);
  const Point p{0, 0, 0}, q{1, 0, 1.0 / 3}, r{0, 1, 1.0 / 3};
  const double z = 2 * (1.0 / 3);
  EXPECT_EQ(exact_orientation(p, q, r, {1, 1, z}), 0);
  EXPECT_EQ(exact_orientation(p, q, r, {1, 1, z + u}), 1);
  EXPECT_EQ(exact_orientation(p, q, r, {1, 1, z - u}), -1);
}

TEST(Polyline, NearestWithinAPart) {
  const Polyline line({{0, 0, 0}, {2, 0, 0}, {2, 3, 0}});
  EXPECT_EQ(line.length(), 5);
  EXPECT_EQ(line.nearest({1, 1, 0}).arc, 1);
  EXPECT_EQ(line.nearest({1, 1, 0}, 2.5, 5).arc, 3);
  EXPECT_EQ(line.nearest({0, 0, 0}, 0.5, 5).arc, 0.5);
  EXPECT_EQ(line.nearest({0, 0, 0}, 0.5, 5).distance, 0.5);
  EXPECT_EQ(line.nearest({2, 9, 0}, 0, 4).arc, 4);
  EXPECT_EQ(line.at(4), (Point{2, 2, 0}));
  EXPECT_EQ(line.corners_between(0, 5).last - line.corners_between(0, 5).first, 1U);
  EXPECT_EQ(line.corners_between(2, 5).last - line.corners_between(2, 5).first, 0U);
}

TEST(Polyline, StartedElsewhere) {
  const Polyline square({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 0}});
  for (const double start : {0.0, 0.25, 1.0, 3.75}) {
    const Polyline moved = square.started_at(start);
    EXPECT_DOUBLE_EQ(moved.length(), 4);
    EXPECT_EQ(moved.points().front(), square.at(start));
    EXPECT_EQ(moved.points().back(), square.at(start));
    EXPECT_EQ(moved.at(0.5), square.at(std::fmod(start + 0.5, 4)));
  }
}

double distance_to_one(const Point& p, const DistanceTree::Triangle& triangle) {
  return DistanceTree(std::vector{triangle}).nearest(p).distance;
}

TEST(DistanceTree, FindsTheNearestOfAll) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto point = [&] { return Point{unit(random), unit(random), unit(random)}; };
  std::vector<DistanceTree::Triangle> triangles;
  for (int i = 0; i < 300; ++i) {
    const Point a = point(), b = a + 0.2 * point();
    triangles.push_back({a, b, i % 3 == 0 ? b : a + 0.2 * point()});  // a third are segments
  }
  const DistanceTree tree(triangles);
  for (int i = 0; i < 500; ++i) {
    const Point p = 1.5 * point();
    double least = INFINITY;
    for (const auto& t : triangles) least = std::fmin(least, distance_to_one(p, t));
    const auto found = tree.nearest(p);
    EXPECT_EQ(found.distance, least);
    EXPECT_EQ(distance_to_one(p, triangles[found.triangle]), least);
    EXPECT_EQ(tree.nearest(p, 0, static_cast<Index>(i % 300)).distance, least);
    EXPECT_GE(tree.nearest(p, 0.3).distance, least);
    EXPECT_LE(tree.nearest(p, 0.3).distance, std::fmax(least, 0.3));
  }
}

TEST(DistanceTree, DistanceToOneTriangle) {
  const DistanceTree tree(std::vector{DistanceTree::Triangle{{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}}}});
  EXPECT_DOUBLE_EQ(tree.nearest({0.5, 0.5, 3}).distance, 3);
  EXPECT_DOUBLE_EQ(tree.nearest({-3, -4, 0}).distance, 5);
  EXPECT_DOUBLE_EQ(tree.nearest({2, 2, 1}).distance, std::sqrt(3.0));
  EXPECT_DOUBLE_EQ(tree.nearest({1, -1, 0}).distance, 1);
}

TEST(RegionLocator, InsideCavityAndOutside) {
  const auto soup = testing::box_with_cavity(0.2);
  const Plc plc = build_plc({&soup, 1});
  const RegionLocator locator(plc);
  EXPECT_EQ(locator.region_at({0.1, 0.2, 0.3}), 1U);
  EXPECT_EQ(locator.region_at({0.52, 0.47, 0.55}), 0U);
  EXPECT_EQ(locator.region_at({1.5, 0.5, 0.5}), 0U);
}

}  // namespace
}  // namespace collarmesh::check_parts_test
