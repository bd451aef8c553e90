// The rules of boundary layers one by one: directions, rings, and the bounds on tets beside layers.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "check/layer_cells.h"
#include "collarmesh/pipeline.h"
#include "collarmesh/plc_builder.h"
#include "layers/direction.h"
#include "layers/front.h"
#include "support/plc_shapes.h"
#include "support/tagged_cylinder.h"

namespace collarmesh::layering::layer_rules_test {
namespace {

TEST(LayerDirection, IsTheNormalOfOneWall) {
  DirectionSearch search;
  search.add_wall({0, 0.6, 0.8});
  const auto found = search.best();
  ASSERT_TRUE(found);
  EXPECT_NEAR(distance(found->direction, {0, 0.6, 0.8}), 0, 1e-9);
  EXPECT_NEAR(found->least_cosine, 1, 1e-9);
}

TEST(LayerDirection, HasEqualAnglesToThreeWalls) {
  DirectionSearch search;
  for (const Vector& normal : {Vector{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}) search.add_wall(normal);
  const auto found = search.best();
  ASSERT_TRUE(found);
  EXPECT_NEAR(distance(found->direction, Vector{1, 1, 1} / std::sqrt(3.0)), 0, 1e-9);
  EXPECT_NEAR(found->least_cosine, 1 / std::sqrt(3.0), 1e-9);
}

TEST(LayerDirection, DoesNotDependOnHowManyTrianglesAWallHas) {
  DirectionSearch search;
  for (unsigned k = 0; k < 10; ++k) search.add_wall({1, 0, 0});
  search.add_wall({0, 1, 0});
  const auto found = search.best();
  ASSERT_TRUE(found);
  EXPECT_NEAR(distance(found->direction, Vector{1, 1, 0} / std::sqrt(2.0)), 0, 1e-9);
}

/// Compares with many directions: none has a larger smallest cosine.
TEST(LayerDirection, IsTheSteepest) {
  const std::vector<Vector> normals{{0.6, 0, 0.8}, {-0.6, 0, 0.8}, {0, 0.28, 0.96}, {0.48, 0.64, 0.6}};
  DirectionSearch search;
  for (const Vector& normal : normals) search.add_wall(normal);
  const auto found = search.best();
  ASSERT_TRUE(found);
  constexpr unsigned steps = 200;
  for (unsigned i = 0; i < steps; ++i)
    for (unsigned j = 0; j < steps; ++j) {
      const double u = 2 * M_PI * i / steps, w = M_PI * (j + 0.5) / steps;
      const Vector way{std::sin(w) * std::cos(u), std::sin(w) * std::sin(u), std::cos(w)};
      double least = 1;
      for (const Vector& normal : normals) least = std::min(least, dot(way, normal));
      EXPECT_LE(least, found->least_cosine + 1e-5);
    }
}

/// The walls are a plane and two triangles of a curved wall; the means are those of each wall.
TEST(LayerDirection, IsAsSteepAboveMeansOfWalls) {
  const double sine = std::sqrt(0.5);
  DirectionSearch search;
  search.add_wall({0, 0, 1});
  search.add_wall({1, 0, 0});
  search.add_wall({399.0 / 401, 0, -40.0 / 401});
  const auto above_all = search.best();
  ASSERT_TRUE(above_all);
  search.add_mean({0, 0, 1});
  search.add_mean({1, 0, 0});
  const auto found = search.best();
  ASSERT_TRUE(found);
  EXPECT_NEAR(distance(found->direction, {sine, 0, sine}), 0, 1e-6);
  EXPECT_NEAR(found->least_cosine, (399.0 - 40.0) / 401 * sine, 1e-6);
  EXPECT_LT(found->least_cosine, above_all->least_cosine);
}

TEST(LayerDirection, IsNotThatOfMeansWhereItWouldBeFlat) {
  DirectionSearch search;
  search.add_wall({0, 0, 1});
  search.add_wall({0.96, 0, 0.28});
  const auto above_all = search.best();
  search.add_mean({0, 0, 1});
  const auto found = search.best();
  ASSERT_TRUE(above_all && found);
  EXPECT_NEAR(distance(found->direction, above_all->direction), 0, 1e-9);
}

TEST(LayerDirection, ThereIsNoneBetweenOppositeWalls) {
  DirectionSearch search;
  search.add_wall({0, 0, 1});
  search.add_wall({0, 0, -1});
  EXPECT_FALSE(search.best());
}

TEST(LayerDirection, StaysInPlanesAndOnLines) {
  DirectionSearch in_plane;
  in_plane.add_wall(Vector{1, 0, 1} / std::sqrt(2.0));
  in_plane.stay_in_plane({0, 0, 1});
  const auto flat = in_plane.best();
  ASSERT_TRUE(flat);
  EXPECT_NEAR(distance(flat->direction, {1, 0, 0}), 0, 1e-9);
  EXPECT_NEAR(flat->least_cosine, std::sqrt(0.5), 1e-9);
  DirectionSearch on_line;
  on_line.add_wall({0, 0, 1});
  on_line.stay_on_line({0, -0.6, 0.8});
  const auto along = on_line.best();
  ASSERT_TRUE(along);
  EXPECT_NEAR(distance(along->direction, {0, -0.6, 0.8}), 0, 1e-9);
  DirectionSearch into_wall;
  into_wall.add_wall({0, 0, 1});
  into_wall.stay_on_line({0, 0.6, -0.8});
  EXPECT_FALSE(into_wall.best());
  DirectionSearch nowhere;
  nowhere.add_wall({0, 0, 1});
  nowhere.stay_in_plane({0, 0, 1});
  EXPECT_FALSE(nowhere.best());
}

TEST(LayerRings, GrowByNeighbours) {
  Lists path;  // 0 - 1 - 2 - ... - 9
  for (Index n = 0; n < 10; ++n) {
    if (n > 0) path.entries.push_back(n - 1);
    if (n < 9) path.entries.push_back(n + 1);
    path.end_group();
  }
  EXPECT_EQ(within_rings(path, {5, 5}, 0), (std::vector<Index>{5}));
  EXPECT_EQ(within_rings(path, {5}, 2), (std::vector<Index>{3, 4, 5, 6, 7}));
  EXPECT_EQ(within_rings(path, {9, 0}, 1), (std::vector<Index>{0, 1, 8, 9}));
  EXPECT_EQ(within_rings(path, {4}, 100).size(), 10U);
  EXPECT_TRUE(within_rings(path, {}, 3).empty());
}

/// Returns a mesh of one tet, which has this height above a triangle and lies in the middle of the unit cube.
TetMesh flat_tet(double height) {
  TetMesh mesh;
  mesh.points = {{0.4, 0.4, 0.5}, {0.6, 0.4, 0.5}, {0.5, 0.6, 0.5}, {0.5, 0.47, 0.5 + height}};
  mesh.tets = {{0, 1, 2, 3}};
  if (six_volume(mesh.points[0], mesh.points[1], mesh.points[2], mesh.points[3]) < 0)
    std::swap(mesh.tets[0][2], mesh.tets[0][3]);
  mesh.tet_region = {1};
  mesh.tet_tag = {1};
  mesh.features.resize(4, {3, none});
  mesh.layers.tet_layer = {0};
  return mesh;
}

TEST(CoreAngles, AreThoseOfThinTets) {
  const std::vector<PolygonSoup> soups{testing::polygonal_box({0, 0, 0}, {1, 1, 1})};
  const Plc plc = build_plc(soups);
  Bounds bounds;
  bounds.radius_edge = 2;
  bounds.thin_angle = 8;
  const auto findings = [&](const TetMesh& mesh) {
    CheckReport report;
    checks::check_core_angles(mesh, {}, plc, bounds, report);
    return report.findings_total;
  };
  EXPECT_EQ(findings(flat_tet(0.14)), 0U);
  EXPECT_EQ(findings(flat_tet(0.002)), 1U);
  TetMesh in_layer = flat_tet(0.002);
  in_layer.layers.tet_layer = {1};
  EXPECT_EQ(findings(in_layer), 0U);  // flat as layers are
}

// Nodes of layers on the bottom of a cylinder slide along its round side.
TEST(LayerHeights, NodesThatSlideAlongACurvedFaceStayOnIt) {
  constexpr unsigned around = 48;
  const double chord = std::cos(std::numbers::pi / around);
  const PolygonSoup soup = testing::with_tagged_ends(testing::polygonal_cylinder(around, 1, 2), 2);
  PipelineOptions options;
  options.mesh.size = 0.5;
  options.mesh.bounds.distance = 0.02;
  options.layers.walls = {"2:first=0.02,count=3"};
  const SoupPipelineResult made = run_pipeline({&soup, 1}, options);
  ASSERT_EQ(made.missed(), "");
  const TetMesh& mesh = made.result.mesh;
  ASSERT_GT(mesh.layers.quads.size(), 10U);
  std::size_t on_side = 0;
  for (std::size_t q = 0; q < mesh.layers.quads.size(); ++q) {
    EXPECT_EQ(mesh.layers.quad_tag[q], 1);
    for (const Index v : mesh.layers.quads[q]) {
      const double radius = std::hypot(mesh.points[v].x, mesh.points[v].y);
      EXPECT_GT(radius, chord - options.mesh.bounds.distance);
      EXPECT_LT(radius, 1 + options.mesh.bounds.distance);
      ++on_side;
    }
  }
  EXPECT_GT(on_side, 0U);
  ASSERT_EQ(made.layers->patches.size(), 1U);
  EXPECT_NEAR(made.layers->patches[0].area, std::numbers::pi, 0.2);
  EXPECT_GT(made.layers->coverage(), 0.9);
}

}  // namespace
}  // namespace collarmesh::layering::layer_rules_test
