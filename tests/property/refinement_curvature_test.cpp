// Sizes that follow the shape: curvature and gaps, each recomputed from the mesh.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "support/meshing.h"
#include "support/shapes.h"
#include "tolerance/curvature.h"

namespace collarmesh::refinement_curvature_test {
namespace {

using testing::faults;
using testing::mesh_of;
using testing::Meshed;
using testing::with_size;

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2),
                   values.end());
  return values.at(values.size() / 2);
}

// Measures the faces that `counts` accepts.
template <class Counts>
double median_face_edge(const TetMesh& mesh, const Counts& counts) {
  std::vector<double> lengths;
  for (const auto& f : mesh.faces) {
    const Point middle = (mesh.points[f[0]] + mesh.points[f[1]] + mesh.points[f[2]]) / 3;
    if (!counts(middle)) continue;
    for (unsigned i = 0; i < 3; ++i)
      lengths.push_back(distance(mesh.points[f[i]], mesh.points[f[(i + 1) % 3]]));
  }
  return median(lengths);
}

Plc complex_of(const PolygonSoup& soup) { return build_plc(std::span(&soup, 1), {.feature_angle = 30}); }

std::vector<double> sizes_of_patch(const Plc& plc, const CurvatureSizes& sizes, bool planar) {
  std::vector<double> found;
  for (std::size_t t = 0; t < plc.triangles.size(); ++t)
    if (plc.patches[plc.triangles[t].patch].planar == planar) found.push_back(sizes.triangle[t]);
  return found;
}

TEST(Curvature, OfSpheresCylindersAndTori) {
  const double circle = 2 * std::numbers::pi;
  const Plc sphere = complex_of(testing::icosphere(3, 12));
  for (const double size : curvature_sizes(sphere, 10).triangle)
    EXPECT_NEAR(size, 3 * circle / 10, 0.2 * 3 * circle / 10);

  for (const unsigned rings : {1U, 5U}) {
    const Plc cylinder = complex_of(testing::cylinder(0.5, 2, 36, rings));
    const CurvatureSizes sizes = curvature_sizes(cylinder, 8);
    for (const double size : sizes_of_patch(cylinder, sizes, true)) EXPECT_EQ(size, INFINITY);
    for (const double size : sizes_of_patch(cylinder, sizes, false))
      EXPECT_NEAR(size, 0.5 * circle / 8, 0.1 * circle / 16);
    ASSERT_EQ(sizes.curve_segment.size(), 2U);
    for (const auto& rim : sizes.curve_segment)
      for (const double size : rim) EXPECT_NEAR(size, 0.5 * circle / 8, 0.02 * circle / 16);
  }

  const Plc torus = complex_of(testing::torus(2, 0.5, 96, 24));  // the smaller circle determines the size
  for (const double size : curvature_sizes(torus, 12).triangle)
    EXPECT_NEAR(size, 0.5 * circle / 12, 0.15 * 0.5 * circle / 12);
}

TEST(Curvature, PutsElementsOnACircle) {
  for (const double elements : {16.0, 32.0}) {
    MeshOptions options = with_size(1);
    options.elements_per_circle = elements;
    options.bounds.distance = 0.1;  // the distance alone would allow larger edges
    const Meshed meshed = mesh_of(testing::icosphere(1, 16), options);
    EXPECT_EQ(faults(meshed), "");
    const double wanted = 2 * std::numbers::pi / elements;
    EXPECT_NEAR(median_face_edge(meshed.result.mesh, [](const Point&) { return true; }), wanted,
                0.2 * wanted);
  }
}

TEST(Curvature, LeavesFlatPartsCoarseAndHeedsTheMinimum) {
  MeshOptions options = with_size(1);
  options.bounds.distance = 0.02;
  const PolygonSoup soup = testing::plate_with_hole(0.5, 64);
  const std::size_t without = mesh_of(soup, options).result.mesh.edges.size();
  options.elements_per_circle = 48;
  const Meshed fine = mesh_of(soup, options);
  EXPECT_EQ(faults(fine), "");
  EXPECT_GT(fine.result.mesh.edges.size(), 3 * without / 2);
  std::size_t around = 0;
  for (std::size_t e = 0; e < fine.result.mesh.edges.size(); ++e)
    around += !fine.plc.curves[fine.result.mesh.edge_curve[e]].straight;
  EXPECT_GE(around, 2 * 40U);  // two rims; edges may be 1.3 times the size
  options.size_min = 0.4;
  EXPECT_LT(mesh_of(soup, options).result.mesh.edges.size(), 2 * fine.result.mesh.edges.size() / 3);
}

TEST(Gaps, GetElementsAcross) {
  for (const double elements : {2.0, 4.0}) {
    MeshOptions options = with_size(0.3);
    options.elements_across_gap = elements;
    const Meshed meshed = mesh_of(testing::box({0, 0, 0}, {1, 1, 0.1}), options, 0);
    EXPECT_EQ(faults(meshed), "");
    const double wanted = 0.1 / elements;
    const auto top = [](const Point& p) { return std::fabs(p.z - 0.1) < 1e-9; };
    EXPECT_NEAR(median_face_edge(meshed.result.mesh, top), wanted, 0.2 * wanted);
    EXPECT_LT(meshed.report.median_edge, 1.5 * wanted);
  }
}

TEST(Gaps, AreThoseOfTheThinPartAlone) {
  // A thick block with a thin plate beside it.
  const std::vector<Point> profile{{0, 0, 0}, {4, 0, 0}, {4, 0.2, 0}, {2, 0.2, 0}, {2, 2, 0}, {0, 2, 0}};
  MeshOptions options = with_size(0.5);
  options.elements_across_gap = 2;
  const Meshed meshed = mesh_of(testing::extrusion(profile, 2), options, 0);
  EXPECT_EQ(faults(meshed), "");
  const TetMesh& mesh = meshed.result.mesh;
  EXPECT_NEAR(median_face_edge(mesh, [](const Point& p) { return std::fabs(p.y - 0.2) < 1e-9; }), 0.1, 0.03);
  EXPECT_GT(median_face_edge(mesh, [](const Point& p) { return std::fabs(p.y - 2) < 1e-9; }), 0.3);
}

TEST(Gaps, InAWedgeDoNotClose) {
  const std::vector<Point> profile{{0, 0, 0}, {2, 0, 0}, {2, 1.5, 0}};  // an angle of 37 degrees
  MeshOptions options = with_size(0.5);
  const std::size_t without = mesh_of(testing::extrusion(profile, 1), options, 0).result.mesh.tets.size();
  options.elements_across_gap = 1;
  const Meshed meshed = mesh_of(testing::extrusion(profile, 1), options, 0);
  EXPECT_EQ(faults(meshed), "");
  EXPECT_LT(meshed.result.mesh.tets.size(), 3 * without);
}

}  // namespace
}  // namespace collarmesh::refinement_curvature_test
