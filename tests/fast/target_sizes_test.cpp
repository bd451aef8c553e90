// Target edge lengths at the vertices of a mesh, and the surfaces that face each other, on shapes whose
// widths and radii are known.
#include "coarsen/target_sizes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "collarmesh/plc_builder.h"
#include "refine/sizing.h"
#include "support/meshing.h"
#include "support/shapes.h"
#include "tolerance/facing.h"

namespace collarmesh::target_sizes_test {
namespace {

using namespace testing;

using remeshing::coarsening::target_sizes;

constexpr double pi = std::numbers::pi;

/// Expects that sizes grow by at most this share of the length of each edge.
void expect_graded(const TetMesh& mesh, const std::vector<double>& sizes, double growth) {
  for (const auto& tet : mesh.tets)
    for (const Index a : tet)
      for (const Index b : tet)
        EXPECT_LE(sizes[a], sizes[b] + growth * distance(mesh.points[a], mesh.points[b]) + 1e-12);
}

TEST(TargetSizes, GapsAreDividedIntoElements) {
  constexpr double thickness = 0.2, elements = 2;
  const Meshed meshed = mesh_of(box({0, 0, 0}, {2, 2, thickness}), with_size(0.5), 0);
  const TetMesh& mesh = meshed.result.mesh;
  MeshOptions options = with_size(0.5);
  options.elements_across_gap = elements;
  const std::vector<double> sizes = target_sizes(mesh, meshed.plc, options);
  std::size_t on_plate = 0;
  for (Index v = 0; v < mesh.points.size(); ++v) {
    if (mesh.points[v].z != 0 && mesh.points[v].z != thickness) continue;
    ++on_plate;
    EXPECT_NEAR(sizes[v], thickness / elements, 1e-12);
  }
  EXPECT_GT(on_plate, 8U);
  expect_graded(mesh, sizes, 0.25);
  // In a thick plate no gap is narrower than two elements.
  const Meshed thick = mesh_of(box({0, 0, 0}, {2, 2, 2}), with_size(0.5), 0);
  for (const double size : target_sizes(thick.result.mesh, thick.plc, options))
    EXPECT_DOUBLE_EQ(size, Sizing::edge_per_size * 0.5);
}

TEST(TargetSizes, CirclesAreDividedIntoElements) {
  constexpr double elements = 20;
  const Meshed meshed = mesh_of(cylinder(1, 2, 64), with_size(0.5));
  const TetMesh& mesh = meshed.result.mesh;
  MeshOptions options = with_size(0.5);
  options.elements_per_circle = elements;
  const std::vector<double> sizes = target_sizes(mesh, meshed.plc, options);
  std::array<std::size_t, 4> count{};
  for (Index v = 0; v < mesh.points.size(); ++v) {
    const auto [dimension, feature] = mesh.features[v];
    const bool is_round = (dimension == 1 && !meshed.plc.curves[feature].straight) ||
                          (dimension == 2 && !meshed.plc.patches[feature].planar);
    if (!is_round) continue;
    ++count[dimension];
    EXPECT_NEAR(sizes[v], 2 * pi / elements, 0.1 * 2 * pi / elements);
  }
  EXPECT_GT(count[1], 10U);
  EXPECT_GT(count[2], 5U);
  EXPECT_GT(*std::max_element(sizes.begin(), sizes.end()), 0.45);
}

TEST(TargetSizes, SizesOfPatchesGrowByTheGradation) {
  const Meshed meshed = mesh_of(box(), with_size(0.2), 0);
  const TetMesh& mesh = meshed.result.mesh;
  MeshOptions options = with_size(0.5);
  options.patch_size = {{5, 0.05}};  // z = 0
  options.gradation = 0.3;
  const std::vector<double> sizes = target_sizes(mesh, meshed.plc, options);
  const double least = Sizing::edge_per_size * 0.05;
  for (Index v = 0; v < mesh.points.size(); ++v) {
    if (mesh.points[v].z == 0) {
      EXPECT_DOUBLE_EQ(sizes[v], least);
    }
    EXPECT_GE(sizes[v], std::min(least + 0.3 * mesh.points[v].z, Sizing::edge_per_size * 0.5) - 1e-12);
  }
  expect_graded(mesh, sizes, 0.3);
}

// FacingSurfaces

/// Two plates above each other in z.
struct Plates {
  double thickness, gap;
  Plc plc;

  Plates(double t, double g) : thickness(t), gap(g) {
    const std::vector<PolygonSoup> soups{box({0, 0, 0}, {1, 1, t}), box({0, 0, t + g}, {1, 1, 2 * t + g})};
    plc = build_plc(soups);
  }
  Index triangle_at(double z) const {
    for (Index t = 0; t < plc.triangles.size(); ++t)
      if (std::ranges::all_of(plc.triangles[t].points, [&](Index p) { return plc.points[p].z == z; }))
        return t;
    return none;
  }
};

TEST(FacingSurfaces, AreFoundAcrossMaterialAndGaps) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(0.05, 0.95);
  for (int i = 0; i < 20; ++i) {
    const Plates plates(0.2 * unit(random), 0.3 * unit(random));
    const FacingSurfaces facing(plates.plc);
    FacingSurfaces::Crossings crossings;
    const double top = plates.thickness;
    const Index triangle = plates.triangle_at(top);
    ASSERT_NE(triangle, none);
    const Plc::Patch& patch = plates.plc.patches[plates.plc.triangles[triangle].patch];
    const unsigned inside = patch.regions[0] != 0 ? 0 : 1;
    for (const unsigned side : {0U, 1U}) {
      const double width = side == inside ? plates.thickness : plates.gap;
      const Point x{unit(random), unit(random), top};
      const FacingSurfaces::Facing found = facing.from(x, triangle, side, 1, crossings);
      EXPECT_NEAR(found.distance, width, 1e-9);
      ASSERT_NE(found.triangle, none);
      const double other = side == inside ? 0 : top + plates.gap;
      for (const Index p : plates.plc.triangles[found.triangle].points)
        EXPECT_EQ(plates.plc.points[p].z, other);
      EXPECT_EQ(facing.from(x, triangle, side, 0.99 * width, crossings).distance, INFINITY);
    }
  }
}

// Beyond the upper plate there is nothing, and sides that meet at a right angle do not face each other.
TEST(FacingSurfaces, AreNotThereBeyondTheShape) {
  const Plates plates(0.1, 0.2);
  const FacingSurfaces facing(plates.plc);
  FacingSurfaces::Crossings crossings;
  const Index triangle = plates.triangle_at(2 * plates.thickness + plates.gap);
  ASSERT_NE(triangle, none);
  const Plc::Patch& patch = plates.plc.patches[plates.plc.triangles[triangle].patch];
  const unsigned outside = patch.regions[0] != 0 ? 1 : 0;
  const FacingSurfaces::Facing found = facing.from({0.5, 0.4, 0.4}, triangle, outside, 10, crossings);
  EXPECT_EQ(found.distance, INFINITY);
  EXPECT_EQ(found.triangle, none);
}

}  // namespace
}  // namespace collarmesh::target_sizes_test
