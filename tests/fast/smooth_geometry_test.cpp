#include "adapt/smooth_geometry.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "collarmesh/plc_builder.h"
#include "support/plc_shapes.h"
#include "support/shapes.h"

namespace collarmesh::smooth_geometry_test {
namespace {

using remeshing::adapting::smooth_geometry;

Plc complex_of(const PolygonSoup& soup, double feature_angle = 50) {
  PlcOptions options;
  options.feature_angle = feature_angle;
  return build_plc({&soup, 1}, options);
}

/// Returns corners, points on sides and points inside of a triangle.
std::vector<Point> samples(const Plc& plc, const Plc::Triangle& triangle) {
  constexpr int parts = 6;
  std::array<Point, 3> p;
  for (unsigned i = 0; i < 3; ++i) p[i] = plc.points[triangle.points[i]];
  std::vector<Point> found;
  for (int i = 0; i <= parts; ++i)
    for (int j = 0; i + j <= parts; ++j)
      found.push_back((i * p[0] + j * p[1] + (parts - i - j) * p[2]) / parts);
  return found;
}

struct Measures {
  double off = 0;    // largest distance from the shape that the facets approximate
  double moved = 0;  // largest distance from the facets
};

/// `off`: the distance of a point from the shape.
template <class Off>
Measures measure(const Plc& plc, double tolerance, const Off& off) {
  const ExactGeometry smooth = smooth_geometry(plc, SurfaceTolerance(tolerance));
  Measures measures;
  for (const Plc::Triangle& t : plc.triangles)
    for (const Point& p : samples(plc, t)) {
      const std::optional<Point> place = smooth(2, t.patch, p);
      EXPECT_EQ(place.has_value(), !plc.patches[t.patch].planar);
      if (!place) continue;
      EXPECT_NEAR(distance(*smooth(2, t.patch, *place), *place), 0, 1e-12) << "idempotent";
      measures.off = std::max(measures.off, off(*place));
      measures.moved = std::max(measures.moved, distance(p, *place));
    }
  return measures;
}

double off_sphere(const Point& p) { return std::fabs(norm(p) - 1); }
double off_cylinder(const Point& p) { return std::fabs(std::hypot(p.x, p.y) - 1); }

TEST(SmoothGeometry, IsNearTheSphereBehindItsFacets) {
  const Plc plc = complex_of(testing::icosphere(1, 3));
  const Measures found = measure(plc, 1, off_sphere);
  EXPECT_GT(found.moved, 0.025);
  EXPECT_LT(found.off, 0.03 * found.moved);
}

TEST(SmoothGeometry, StaysWithinTheTolerance) {
  const Plc plc = complex_of(testing::icosphere(1, 3));
  const Measures found = measure(plc, 0.02, off_sphere);
  EXPECT_LT(found.moved, 0.02);
  EXPECT_GT(found.moved, 0.01);
}

TEST(SmoothGeometry, IsNearTheCylinderBehindItsFacets) {
  const Plc plc = complex_of(testing::cylinder(1, 2, 16, 4));
  const Measures found = measure(plc, 1, off_cylinder);
  EXPECT_GT(found.moved, 0.015);
  EXPECT_LT(found.off, 0.1 * found.moved);
}

TEST(SmoothGeometry, IsNearTheSphereUpToACut) {
  std::vector<Point> profile;
  for (int i = 0; i <= 6; ++i) {
    const double angle = std::acos(-1.0) / 2 * (i - 3.0) / 6;
    profile.push_back({std::cos(angle), 0, std::sin(angle)});
  }
  profile.insert(profile.begin(), {0, 0, profile.front().z});
  profile.push_back({0, 0, profile.back().z});
  const Measures found = measure(complex_of(testing::revolution(profile, 20)), 1, off_sphere);
  EXPECT_GT(found.moved, 0.01);
  EXPECT_LT(found.off, 0.15 * found.moved);
}

TEST(SmoothGeometry, CurvesAreNearTheirCircles) {
  const Plc plc = complex_of(testing::cylinder(1, 2, 16, 4));
  const ExactGeometry smooth = smooth_geometry(plc, SurfaceTolerance(1));
  ASSERT_EQ(plc.curves.size(), 2U);
  for (Index c = 0; c < plc.curves.size(); ++c) {
    const std::vector<Index>& points = plc.curves[c].points;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Point &a = plc.points[points[i]], &b = plc.points[points[(i + 1) % points.size()]];
      for (const double share : {0.0, 0.1, 0.5, 0.8}) {
        const Point place = smooth(1, c, a + share * (b - a)).value();
        EXPECT_LT(off_cylinder(place), 2e-4);
        EXPECT_EQ(place.z, a.z);
        EXPECT_NEAR(distance(smooth(1, c, place).value(), place), 0, 1e-12);
      }
    }
  }
}

TEST(SmoothGeometry, LeavesFoldsSharp) {
  const Plc folded = complex_of(testing::subdivided_box({0, 0, 0}, {1, 1, 1}, 2), 100);
  ASSERT_EQ(folded.patches.size(), 1U);
  ASSERT_FALSE(folded.patches[0].planar);
  EXPECT_LT(measure(folded, 1, [](const Point&) { return 0.0; }).moved, 1e-15);
}

}  // namespace
}  // namespace collarmesh::smooth_geometry_test
