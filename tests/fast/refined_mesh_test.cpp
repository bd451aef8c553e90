// The mesh of a refinement: searches, and the features of vertices.
#include "refine/refined_mesh.h"

#include <gtest/gtest.h>

#include <random>

namespace collarmesh::refined_mesh_test {
namespace {

Box unit_box() {
  Box box;
  box.add(Point{0, 0, 0});
  box.add(Point{1, 1.1, 1.2});
  return box;
}

/// Returns two patches that share curve 0, which ends at vertex 0.
Plc two_patches() {
  Plc plc;
  plc.patches.resize(2);
  plc.curves.resize(1);
  plc.vertices.resize(1);
  plc.vertices[0] = {.point = 0, .curves = {0}, .patches = {0, 1}};
  plc.curves[0].patches = {0, 1};
  return plc;
}

Index insert(RefinedMesh& mesh, const Point& p, const Feature& feature) {
  ConflictZone zone;
  mesh.find_conflict_zone(p, mesh.conflicting_cell_around(mesh.nearest_vertex(p), p), zone);
  return mesh.insert(zone, feature);
}

TEST(RefinedMesh, NearestVertexEqualsBruteForceFromTheBoxOn) {
  const Plc plc;
  RefinedMesh mesh(plc, unit_box());
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> unit(0.01, 0.99);
  for (int k = 0; k < 200; ++k) {
    const Point p{unit(random), unit(random), unit(random)};
    Index nearest = 0;
    for (Index v = 1; v < mesh.vertex_count(); ++v)
      if (squared_distance(p, mesh.point(v)) < squared_distance(p, mesh.point(nearest))) nearest = v;
    EXPECT_EQ(mesh.nearest_vertex(p), nearest);
    EXPECT_EQ(mesh.nearest_vertex(p, 8 % mesh.vertex_count()), nearest);
    insert(mesh, p, {3, none});
  }
}

TEST(RefinedMesh, ACellIsAliveAsLongAsItsGeneration) {
  const Plc plc;
  RefinedMesh mesh(plc, unit_box());
  insert(mesh, {0.5, 0.5, 0.5}, {3, none});
  ConflictZone zone;
  const Point p{0.4, 0.3, 0.6};
  mesh.find_conflict_zone(p, mesh.conflicting_cell_around(mesh.nearest_vertex(p), p), zone);
  const Index cell = zone.cells[0];
  const std::uint32_t generation = mesh.generation(cell);
  EXPECT_TRUE(mesh.alive(cell, generation));
  mesh.insert(zone, {3, none});
  EXPECT_FALSE(mesh.alive(cell, generation));
}

TEST(RefinedMesh, AVertexLiesOnWhatItsFeatureBounds) {
  const Plc plc = two_patches();
  RefinedMesh mesh(plc, unit_box());
  const Index on_vertex = insert(mesh, {0.5, 0.5, 0.5}, {0, 0}),
              on_curve = insert(mesh, {0.6, 0.5, 0.5}, {1, 0});
  const Index on_first = insert(mesh, {0.5, 0.6, 0.5}, {2, 0}),
              on_second = insert(mesh, {0.5, 0.5, 0.6}, {2, 1});
  const Index inside = insert(mesh, {0.3, 0.3, 0.3}, {3, none});
  for (const Index patch : {0U, 1U}) {
    EXPECT_TRUE(mesh.on_patch(on_vertex, patch));
    EXPECT_TRUE(mesh.on_patch(on_curve, patch));
    EXPECT_EQ(mesh.on_patch(on_first, patch), patch == 0);
    EXPECT_FALSE(mesh.on_patch(inside, patch));
    EXPECT_FALSE(mesh.on_patch(0, patch));  // a corner of the box
  }
  EXPECT_TRUE(mesh.on_one_patch(std::vector<Index>{on_vertex, on_curve, on_first}));
  EXPECT_TRUE(mesh.on_one_patch(std::vector<Index>{on_second, on_curve, on_vertex}));
  EXPECT_FALSE(mesh.on_one_patch(std::vector<Index>{on_first, on_second}));
  EXPECT_FALSE(mesh.on_one_patch(std::vector<Index>{on_curve, inside}));
}

TEST(RefinedMesh, FeaturesBecomeLowerOnly) {
  const Plc plc = two_patches();
  RefinedMesh mesh(plc, unit_box());
  const Index v = insert(mesh, {0.5, 0.5, 0.5}, {2, 1});
  mesh.lower_feature(v, {2, 0});
  mesh.lower_feature(v, {3, none});
  EXPECT_EQ(mesh.feature(v), (Feature{2, 1}));
  mesh.lower_feature(v, {1, 0});
  EXPECT_EQ(mesh.feature(v), (Feature{1, 0}));
  mesh.lower_feature(v, {2, 1});
  EXPECT_EQ(mesh.feature(v), (Feature{1, 0}));
}

}  // namespace
}  // namespace collarmesh::refined_mesh_test
