// Shapes without creases through `generate`; every mesh is judged by the certificate and by known properties
// of the shape.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

#include "support/meshing.h"
#include "support/shapes.h"

namespace collarmesh::refinement_test {
namespace {

using testing::faults;
using testing::mesh_of;
using testing::Meshed;
using testing::with_size;

constexpr double pi = std::numbers::pi;

void expect_volumes(const Meshed& meshed, const std::vector<double>& expected) {
  const auto& found = meshed.report.region_volumes;
  ASSERT_EQ(found.size(), expected.size() + 1);
  for (std::size_t r = 1; r < found.size(); ++r)
    EXPECT_NEAR(found[r], expected[r - 1], 1e-12 * expected[r - 1]) << "region " << r;
}

// Meshes a planar shape at a coarse and at a fine size: volume may be lost only by rounding.
void expect_exact(std::span<const PolygonSoup> soups, double coarse, double fine,
                  const std::vector<double>& volumes) {
  for (const double size : {coarse, fine}) {
    SCOPED_TRACE(size);
    const Meshed meshed = mesh_of(soups, with_size(size), 0);
    EXPECT_EQ(faults(meshed), "");
    expect_volumes(meshed, volumes);
  }
}
void expect_exact(const PolygonSoup& soup, double coarse, double fine, const std::vector<double>& volumes) {
  expect_exact({&soup, 1}, coarse, fine, volumes);
}

// Meshes a curved shape: the volume is right within the tolerance times the area.
void expect_close(const PolygonSoup& soup, double coarse, double fine, double volume, double area) {
  for (const double size : {coarse, fine}) {
    SCOPED_TRACE(size);
    const Meshed meshed = mesh_of(soup, with_size(size));
    EXPECT_EQ(faults(meshed), "");
    EXPECT_NEAR(meshed.report.region_volumes.at(1), volume,
                default_distance(size, meshed.plc.bounds.diagonal()) * area);
  }
}

double polygon_area(unsigned corners, double radius) {
  return 0.5 * corners * radius * radius * std::sin(2 * pi / corners);
}

TEST(RefinementShapes, Box) { expect_exact(testing::box(), 0.4, 0.1, {1}); }

TEST(RefinementShapes, FlatBox) { expect_exact(testing::box({0, 0, 0}, {1, 2, 0.02}), 0.5, 0.05, {0.04}); }

TEST(RefinementShapes, SidesInManyTriangles) {
  expect_exact(testing::box({0, 0, 0}, {1, 1, 1}, 12), 0.5, 0.15, {1});
}

TEST(RefinementShapes, LShape) { expect_exact(testing::l_shape(), 0.6, 0.2, {3}); }

TEST(RefinementShapes, Prism) { expect_exact(testing::regular_prism(7), 0.6, 0.2, {polygon_area(7, 1)}); }

TEST(RefinementShapes, RandomPrisms) {
  for (std::uint32_t seed = 1; seed <= 6; ++seed) {
    SCOPED_TRACE(seed);
    const PolygonSoup prism = testing::random_prism(seed);
    expect_exact(prism, 0.5, 0.25, {mesh_of(prism, with_size(1), 0).plc.regions.at(1).volume});
  }
}

TEST(RefinementShapes, PlateWithHole) {
  expect_exact(testing::plate_with_hole(1, 16), 1, 0.4, {16 - polygon_area(16, 1)});
}

TEST(RefinementShapes, Sphere) { expect_close(testing::icosphere(1, 12), 0.4, 0.15, 4 * pi / 3, 4 * pi); }

TEST(RefinementShapes, PlateWithSmoothHole) {
  expect_close(testing::plate_with_hole(1, 64), 1, 0.4, 16 - pi, 2 * pi);
}

TEST(RefinementShapes, Cylinder) { expect_close(testing::cylinder(1, 2, 64, 3), 0.5, 0.2, 2 * pi, 8 * pi); }

TEST(RefinementShapes, Torus) {
  expect_close(testing::torus(2, 0.7, 64, 32), 0.6, 0.25, 2 * pi * pi * 2 * 0.49, 4 * pi * pi * 2 * 0.7);
}

TEST(RefinementShapes, NestedBoxes) {
  const auto boxes = testing::nested_boxes(3);
  const auto cube = [](double inset) { return std::pow(1 - 2 * inset, 3); };
  expect_exact(boxes, 0.4, 0.12, {1 - cube(0.15), cube(0.15) - cube(0.3), cube(0.3)});
}

TEST(RefinementShapes, Cavity) { expect_exact(testing::box_with_cavity(0.3), 0.4, 0.12, {1 - 0.027}); }

TEST(RefinementShapes, BoxesThatShareASide) {
  expect_exact(testing::two_boxes(), 0.5, 0.15, {1, 1});
  expect_exact(testing::touching_boxes(), 0.5, 0.15, {1, 1});
}

double area_with_tag(const TetMesh& mesh, Tag tag) {
  double area = 0;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const auto& [a, b, c] = mesh.faces[f];
    if (mesh.face_tag[f] == tag)
      area += norm(cross(mesh.points[b] - mesh.points[a], mesh.points[c] - mesh.points[a])) / 2;
  }
  return area;
}

TEST(RefinementShapes, DanglingFacet) {
  const PolygonSoup soup = testing::box_with_dangling_facet(0.4);
  expect_exact(soup, 0.4, 0.12, {1});
  EXPECT_NEAR(area_with_tag(mesh_of(soup, with_size(0.2)).result.mesh, 7), 0.16, 1e-12);
}

TEST(RefinementShapes, LooseSegmentsAndPoints) {
  PolygonSoup soup = testing::box();
  soup.points.insert(soup.points.end(),
                     {{0.3, 0.3, 0.4}, {0.7, 0.4, 0.6}, {0.2, 0.8, 0.8}, {0.51, 0.5, 0.1}});
  soup.segments.push_back({8, 9, 5});
  soup.region_points = {{{0.1, 0.1, 0.1}, 1, 0}};
  expect_exact(soup, 0.4, 0.12, {1});
  for (const double size : {0.4, 0.12}) {
    const TetMesh mesh = mesh_of(soup, with_size(size)).result.mesh;
    for (const Point& p : soup.points) EXPECT_TRUE(testing::has_vertex_at(mesh, p));
    double length = 0;
    for (std::size_t e = 0; e < mesh.edges.size(); ++e)
      if (mesh.edge_tag[e] == 5)
        length += distance(mesh.points[mesh.edges[e][0]], mesh.points[mesh.edges[e][1]]);
    EXPECT_NEAR(length, distance(soup.points[8], soup.points[9]), 1e-12);
  }
}

// Small features, with sizes ten times larger.

// A sphere of radius 1 with a smooth bump on its pole: the radius grows by h exp(-(angle/w)^2).
PolygonSoup bumped_sphere(double height, double width) {
  std::vector<Point> profile;
  const auto add = [&](double from_pole) {
    const double radius = 1 + height * std::exp(-(from_pole / width) * (from_pole / width));
    profile.push_back({radius * std::sin(from_pole), 0, radius * std::cos(from_pole)});
  };
  for (int i = 0; i <= 24; ++i) add(pi - (pi - 4 * width) * i / 24);
  for (int i = 1; i <= 60; ++i) add(4 * width * (60 - i) / 60);
  profile.front().x = profile.back().x = 0;
  return testing::revolution(profile, 48);
}

TEST(RefinementSmallFeatures, ThinSpikeOnASphere) {
  int tips = 0;
  for (const double size : {1.0, 0.44, 0.42, 0.4, 0.38, 0.36}) {
    SCOPED_TRACE(size);
    const Meshed meshed = mesh_of(bumped_sphere(0.5, size == 1 ? 0.1 : 0.04), with_size(size));
    EXPECT_EQ(faults(meshed), "");
    EXPECT_EQ(meshed.plc.curves.size(), 0U);
    const double diagonal = meshed.plc.bounds.diagonal(),
                 missing = testing::distance_to_faces(meshed.result.mesh, {0, 0, 1.5});
    EXPECT_LE(missing, default_distance(size, diagonal));
    tips += missing <= 1e-3 * diagonal ? 1 : 0;
  }
  EXPECT_GE(tips, 5);  // most meshes miss hardly anything of the tip
}

TEST(RefinementSmallFeatures, FilletedSpikeOnASphere) {
  const Meshed meshed = mesh_of(testing::spiked_sphere(0.03, 0.4), with_size(0.6));
  EXPECT_EQ(faults(meshed), "");
  EXPECT_LE(testing::distance_to_faces(meshed.result.mesh, {0, 0, 1.4}), 1e-3 * meshed.plc.bounds.diagonal());
}

TEST(RefinementSmallFeatures, TinyCavity) {
  for (const double size : {0.04, 1e-3, 1e-5})
    expect_exact(testing::box_with_cavity(size), 0.8, 0.4, {1 - size * size * size});
}

TEST(RefinementSmallFeatures, TinyFacet) {
  for (const double size : {0.04, 1e-3, 1e-5}) {
    SCOPED_TRACE(size);
    const Meshed meshed =
        mesh_of(testing::box_with_small_facet(size), with_size(std::max(0.3, 10 * size)), 0);
    EXPECT_EQ(faults(meshed), "");
    EXPECT_NEAR(area_with_tag(meshed.result.mesh, 7), size * size, 1e-12);
  }
}

// A tessellated sphere far smaller than the cells around it.
TEST(RefinementSmallFeatures, TinySphere) {
  const PolygonSoup small = testing::translated(testing::icosphere(0.02, 6), {0.43, 0.57, 0.52});
  const std::vector<PolygonSoup> soups{testing::box(), small};
  const Meshed meshed = mesh_of(soups, with_size(0.4));
  EXPECT_EQ(faults(meshed), "");
  ASSERT_EQ(meshed.plc.regions.size(), 3U);
  EXPECT_GT(meshed.report.region_volumes[2], 0);
}

// Points on two skew lines have a Delaunay triangulation of quadratic size; the refined mesh must have linear
// size.
TEST(RefinementSkewLines, VerticesGrowLinearly) {
  std::vector<double> vertices;
  for (const unsigned n : {250U, 500U, 1000U}) {
    const PolygonSoup soup = testing::box_with_skew_lines(n);
    const Meshed meshed = mesh_of(soup, with_size(0.5));
    EXPECT_EQ(faults(meshed), "");
    std::vector<Point> wanted = soup.points, found = meshed.result.mesh.points;
    const auto less = [](const Point& a, const Point& b) {
      return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
    };
    std::sort(wanted.begin(), wanted.end(), less);
    std::sort(found.begin(), found.end(), less);
    EXPECT_TRUE(std::includes(found.begin(), found.end(), wanted.begin(), wanted.end(), less)) << n;
    vertices.push_back(static_cast<double>(meshed.result.statistics.vertices_inserted));
  }
  EXPECT_LT(vertices[1] / vertices[0], 2.3);
  EXPECT_LT(vertices[2] / vertices[1], 2.3);
  EXPECT_LT(vertices[2], 2000 * 40);
}

}  // namespace
}  // namespace collarmesh::refinement_test
