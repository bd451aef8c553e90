// The inputs of other tests have the properties that they claim.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "collarmesh/plc_builder.h"
#include "support/shapes.h"

namespace collarmesh::check_shapes_test {
namespace {

using namespace collarmesh::testing;

constexpr double pi = std::numbers::pi;

// Returns the enclosed volume, by the divergence theorem over fans of the polygons.
double enclosed_volume(const PolygonSoup& soup) {
  double sum = 0;
  for (Index f = 0; f < soup.facet_count(); ++f) {
    const auto corners = soup.polygon(soup.facet_polygons(f)[0]);
    for (std::size_t i = 2; i < corners.size(); ++i)
      sum += dot(cross(soup.points[corners[0]], soup.points[corners[i - 1]]), soup.points[corners[i]]) / 6;
  }
  return sum;
}

Plc complex_of(const PolygonSoup& soup) { return build_plc({&soup, 1}); }
Plc complex_of(const std::vector<PolygonSoup>& soups) { return build_plc(soups); }

TEST(Shapes, VolumesAndOutwardOrientation) {
  EXPECT_NEAR(enclosed_volume(box({1, 2, 3}, {2, 4, 6}, 3)), 6, 1e-12);
  EXPECT_NEAR(enclosed_volume(l_shape()), 3, 1e-12);
  EXPECT_NEAR(enclosed_volume(regular_prism(6, 2)), 3 * std::sqrt(3.0), 1e-12);
  EXPECT_NEAR(enclosed_volume(icosphere(2, 12)), 4 * pi / 3 * 8, 0.3);
  EXPECT_NEAR(enclosed_volume(uv_sphere(1, 40, 60)), 4 * pi / 3, 0.03);
  EXPECT_NEAR(enclosed_volume(cylinder(1, 3, 100, 4)), 3 * pi, 0.02);
  EXPECT_NEAR(enclosed_volume(torus(3, 1, 80, 40)), 6 * pi * pi, 0.5);
  EXPECT_NEAR(enclosed_volume(cone(1, 2, 100, 5)), 2 * pi / 3, 0.01);
  EXPECT_NEAR(enclosed_volume(spiked_sphere(0.05, 0.5)), 4 * pi / 3, 0.06);
  EXPECT_NEAR(enclosed_volume(box_with_cavity(0.1)), 1 - 1e-3, 1e-12);
  EXPECT_GT(enclosed_volume(random_prism(4)), 0.5);
  EXPECT_GT(enclosed_volume(random_hull(4, 20)), 1);
  EXPECT_LT(enclosed_volume(inverted(box())), 0);
}

TEST(Shapes, IcosphereHasTheTrianglesAskedFor) {
  EXPECT_EQ(icosphere(1, 5).facet_count(), 500U);
  EXPECT_EQ(icosphere(1, 5).points.size(), 252U);
  EXPECT_NEAR(icosphere_of(1, 90000).facet_count(), 90000, 1500);
}

TEST(Shapes, ComplexesHaveTheFeaturesNamed) {
  const auto expect = [](const Plc& plc, std::size_t vertices, std::size_t curves, std::size_t patches,
                         std::size_t regions, const char* name) {
    EXPECT_EQ(plc.vertices.size(), vertices) << name;
    EXPECT_EQ(plc.curves.size(), curves) << name;
    EXPECT_EQ(plc.patches.size(), patches) << name;
    EXPECT_EQ(plc.regions.size(), regions + 1) << name;
  };
  expect(complex_of(box({0, 0, 0}, {1, 1, 1}, 4)), 8, 12, 6, 1, "box");
  expect(complex_of(l_shape()), 12, 18, 8, 1, "L");
  expect(complex_of(icosphere(1, 6)), 0, 0, 1, 1, "icosphere");
  expect(complex_of(uv_sphere(1, 20, 40)), 0, 0, 1, 1, "uv sphere");
  expect(complex_of(cylinder(1, 1, 40)), 0, 2, 3, 1, "cylinder");
  expect(complex_of(torus(3, 1, 40, 20)), 0, 0, 1, 1, "torus");
  expect(complex_of(spiked_sphere(0.05, 0.5)), 0, 0, 1, 1, "spike");
  expect(complex_of(box_with_cavity(0.1)), 16, 24, 12, 1, "cavity");
  expect(complex_of(box_with_small_facet(0.01)), 12, 16, 7, 1, "small facet");
  expect(complex_of(two_boxes()), 12, 20, 11, 2, "two boxes");
  expect(complex_of(touching_boxes()), 12, 20, 11, 2, "touching boxes");
  expect(complex_of(box_with_dangling_facet()), 12, 16, 7, 1, "dangling facet");
  expect(complex_of(box_with_skew_lines(5)), 18, 12, 6, 1, "skew lines");
  expect(complex_of(nested_boxes(3)), 24, 36, 18, 3, "nested boxes");
  expect(complex_of(plate_with_hole(1, 40)), 8, 14, 7, 1, "plate");
}

TEST(Shapes, MovedAndPermutedOnesAreTheSame) {
  const PolygonSoup plate = plate_with_hole(1, 24);
  for (const PolygonSoup& soup :
       {permuted(plate, 3), rotated(plate, {1, 2, 3}, 40), translated(plate, {7, 8, 9})}) {
    const Plc plc = complex_of(soup);
    EXPECT_EQ(plc.curves.size(), 14U);
    EXPECT_EQ(plc.patches.size(), 7U);
  }
  EXPECT_NEAR(enclosed_volume(permuted(box(), 5)), 1, 1e-12);
  EXPECT_NEAR(enclosed_volume(scaled(box(), 3)), 27, 1e-12);
}

}  // namespace
}  // namespace collarmesh::check_shapes_test
