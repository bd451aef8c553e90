// Meshes that keep every guarantee pass, with and without feature indices, and their measures are right.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "collarmesh/check.h"
#include "location/triangle_hierarchy.h"
#include "support/acute_shapes.h"
#include "support/meshes.h"
#include "support/meshing.h"

namespace collarmesh::check_right_meshes_test {
namespace {

using namespace collarmesh::testing;

std::string all_messages(const CheckReport& report) {
  std::string text;
  for (const Finding& f : report.findings) text += f.guarantee + ": " + f.message + "\n";
  return text;
}

void expect_pass(const MeshedComplex& m, const CheckOptions& options = {}) {
  const CheckReport with = check(m.mesh, m.plc, options);
  EXPECT_TRUE(with.passed()) << all_messages(with);
  const CheckReport without = check(without_features(m.mesh), m.plc, options);
  EXPECT_TRUE(without.passed()) << all_messages(without);
}

TEST(CheckRightMeshes, Box) {
  for (const Index n : {1, 2, 5}) expect_pass(meshed_box(n));
}

TEST(CheckRightMeshes, TwoRegions) { expect_pass(meshed_two_boxes(3)); }

TEST(CheckRightMeshes, DanglingFacet) { expect_pass(meshed_box_with_facet(4)); }

TEST(CheckRightMeshes, SmoothClosedPatch) { expect_pass(meshed_ball(4, 4), {.bounds = {.distance = 0.05}}); }

TEST(CheckRightMeshes, SmoothCurvesAndPlanarPatches) {
  expect_pass(meshed_cylinder(12, 4), {.bounds = {.distance = 0.05}});
}

// The two triangles of the upper side form one planar patch up to the tolerance. They are tilted against each
// other, so their areas exceed that of the patch's outline seen from above by a relative 8e-9.
TEST(CheckRightMeshes, PlanarPatchOfTiltedTriangles) {
  constexpr double width = 0.005, lift = 0.9e-6;
  PolygonSoup bar;
  bar.points = {{0, 0, 0},
                {1, 0, 0},
                {1, width, 0},
                {0, width, 0},
                {0, 0, width},
                {1, 0, width},
                {1, width, width + lift},
                {0, width, width}};
  const std::vector<std::vector<Index>> facets{{0, 3, 2, 1}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6},
                                               {3, 0, 4, 7}, {4, 5, 7},    {5, 6, 7}};
  for (const auto& facet : facets) bar.add_facet(facet);
  const Meshed meshed = mesh_of(bar, with_size(0.05));
  ASSERT_EQ(meshed.plc.patches.size(), 6U);
  EXPECT_EQ(faults(meshed), "");
}

// Returns the largest distance of the faces' corners, centres and two points on each side from the smooth
// patches.
double largest_distance(const MeshedComplex& m, bool centres_only) {
  double largest = 0;
  for (std::size_t f = 0; f < m.mesh.faces.size(); ++f) {
    const Plc::Patch& patch = m.plc.patches[m.mesh.face_patch[f]];
    if (patch.planar) continue;
    const auto& [i, j, k] = m.mesh.faces[f];
    const Point &a = m.mesh.points[i], &b = m.mesh.points[j], &c = m.mesh.points[k];
    std::vector<Point> samples{(a + b + c) / 3};
    if (!centres_only)
      samples.insert(samples.end(), {a, b, c, (2 * a + b) / 3, (a + 2 * b) / 3, (2 * b + c) / 3,
                                     (b + 2 * c) / 3, (2 * c + a) / 3, (c + 2 * a) / 3});
    for (const Point& p : samples) {
      double nearest = INFINITY;
      for (Index t = patch.first_triangle; t < patch.first_triangle + patch.triangle_count; ++t) {
        const auto& corners = m.plc.triangles[t].points;
        nearest = std::min(nearest,
                           squared_distance_to_triangle(p, m.plc.points[corners[0]], m.plc.points[corners[1]],
                                                        m.plc.points[corners[2]]));
      }
      largest = std::max(largest, std::sqrt(nearest));
    }
  }
  return largest;
}

TEST(CheckRightMeshes, SurfaceDistanceIsThatOfAllSamples) {
  for (MeshedComplex m : {meshed_ball(4, 4), meshed_cylinder(12, 4)}) {
    // Moves one corner off the surface, then a second one and so a whole side, each time farther than any
    // centre is off.
    for (const std::size_t moved : {1U, 2U}) {
      const auto smooth = std::find_if(m.mesh.face_patch.begin(), m.mesh.face_patch.end(),
                                       [&](Index patch) { return !m.plc.patches[patch].planar; });
      const auto& face = m.mesh.faces[static_cast<std::size_t>(smooth - m.mesh.face_patch.begin())];
      const Vector off = m.plc.bounds.centre() - m.mesh.points[face[moved]];
      m.mesh.points[face[moved]] = m.mesh.points[face[moved]] - 0.15 * off;
      const double expected = largest_distance(m, false);
      ASSERT_GT(expected, 1.2 * largest_distance(m, true));
      EXPECT_NEAR(check(m.mesh, m.plc, {.bounds = {.distance = 0.5}}).max_surface_distance, expected, 1e-12);
    }
  }
}

void expect_pass_when_moved(double scale, double shift) {
  MeshedComplex m = meshed_two_boxes(2);
  const auto move = [&](Point& p) { p = scale * p + Point{shift, -shift, 0.7 * shift}; };
  for (Point& p : m.mesh.points) move(p);
  for (Point& p : m.plc.points) move(p);
  for (Plc::Patch& p : m.plc.patches) move(p.origin);
  m.plc.bounds = {};
  for (const Point& p : m.plc.points) m.plc.bounds.add(p);
  expect_pass(m);
}

TEST(CheckRightMeshes, Moved) {
  const double far = 1e6 * std::sqrt(3.0);
  expect_pass_when_moved(1, far);
  expect_pass_when_moved(1e-6, 0);
  expect_pass_when_moved(1e6, 0);
  expect_pass_when_moved(1e30, 0);
  expect_pass_when_moved(1e-30, 0);
  expect_pass_when_moved(1e-6, 1e-6 * far);
}

TEST(CheckRightMeshes, MeasuresOfTheBox) {
  const MeshedComplex m = meshed_box(4);
  const CheckReport report = check(m.mesh, m.plc);
  EXPECT_EQ(report.tets, 6 * 64U);
  EXPECT_EQ(report.points, 125U);
  EXPECT_EQ(report.faces, 6 * 2 * 16U);
  EXPECT_EQ(report.edges, 12 * 4U);
  EXPECT_EQ(report.collar_tets, 0U);
  EXPECT_NEAR(report.max_radius_edge, std::sqrt(3.0) / 2, 1e-12);
  EXPECT_NEAR(report.min_dihedral, 45, 1e-12);
  EXPECT_NEAR(report.max_dihedral, 90, 1e-12);
  EXPECT_NEAR(report.median_edge, std::sqrt(2.0) / 4, 1e-6);
  ASSERT_EQ(report.region_volumes.size(), 2U);
  EXPECT_NEAR(report.region_volumes[1], 1, 1e-14);
  EXPECT_EQ(report.max_surface_distance, 0);
}

/// Returns the numbers of the tets with the most extreme angles, found by sorting all tets.
template <class AngleOf>
std::vector<Index> most_extreme(const TetMesh& mesh, const AngleOf& angle_of) {
  std::vector<std::pair<double, Index>> all;
  for (Index t = 0; t < mesh.tets.size(); ++t) {
    const auto& [a, b, c, d] = mesh.tets[t];
    all.emplace_back(angle_of(measure(mesh.points[a], mesh.points[b], mesh.points[c], mesh.points[d])), t);
  }
  std::sort(all.begin(), all.end());
  std::vector<Index> tets;
  for (std::size_t i = 0; i < std::min(MeshMeasures::listed, all.size()); ++i) tets.push_back(all[i].second);
  return tets;
}

std::vector<Index> tets_of(const std::vector<MeshMeasures::Extreme>& extremes) {
  std::vector<Index> tets;
  for (const MeshMeasures::Extreme& extreme : extremes) tets.push_back(extreme.tet);
  return tets;
}

void expect_measures_of(const TetMesh& mesh, const Plc& plc) {
  const MeshMeasures found = check(mesh, plc).measures, expected = measure_mesh(mesh);
  EXPECT_EQ(std::accumulate(found.radius_edges.begin(), found.radius_edges.end(), std::size_t{0}),
            mesh.tets.size());
  EXPECT_EQ(found.radius_edges, expected.radius_edges);
  EXPECT_EQ(found.min_dihedrals, expected.min_dihedrals);
  EXPECT_EQ(found.max_dihedrals, expected.max_dihedrals);
  EXPECT_EQ(found.region_volumes, expected.region_volumes);
  EXPECT_EQ(found.max_radius_edge, expected.max_radius_edge);
  EXPECT_EQ(found.max_collar_radius_edge, expected.max_collar_radius_edge);
  EXPECT_EQ(tets_of(found.smallest_angles),
            most_extreme(mesh, [](const TetQuality& q) { return q.min_dihedral; }));
  EXPECT_EQ(tets_of(found.largest_angles),
            most_extreme(mesh, [](const TetQuality& q) { return -q.max_dihedral; }));
}

TEST(CheckRightMeshes, MeasuresAreThoseOfAllTets) {
  const MeshedComplex m = meshed_two_boxes(3);
  expect_measures_of(m.mesh, m.plc);
  const Meshed wedge = mesh_of(acute::wedge(30).soups, with_size(0.3), 0);
  EXPECT_GT(wedge.report.collar_tets, 0U);
  expect_measures_of(wedge.result.mesh, wedge.plc);
}

TEST(CheckRightMeshes, MeasuresOfTheBall) {
  const MeshedComplex m = meshed_ball(3, 8);
  const CheckReport report = check(m.mesh, m.plc, {.bounds = {.distance = 0.1}});
  // The farthest places are the centres of the large faces; each is near a point of the fine sphere.
  double sagitta = 0;
  for (const auto& f : m.mesh.faces)
    sagitta =
        std::fmax(sagitta, 1 - norm((m.mesh.points[f[0]] + m.mesh.points[f[1]] + m.mesh.points[f[2]]) / 3));
  EXPECT_NEAR(report.max_surface_distance, sagitta, 0.05 * sagitta);
}

}  // namespace
}  // namespace collarmesh::check_right_meshes_test
