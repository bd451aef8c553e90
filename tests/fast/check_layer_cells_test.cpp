// The certificate of cells of layers: a right mesh passes, and each way to spoil it is found.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <utility>

#include "check/layer_cells.h"
#include "support/layer_mesh.h"

namespace collarmesh::check_layer_cells_test {
namespace {

using testing::LayerMesh;

/// Returns the names of the guarantees that a mesh misses.
std::string missed(const TetMesh& mesh) {
  CheckReport report;
  checks::check_layer_cells(mesh, report);
  std::string names;
  for (const Finding& finding : report.findings)
    if (names.find(finding.guarantee) == std::string::npos) names += finding.guarantee + " ";
  return names;
}

TEST(CheckLayerCells, FindsNothingInARightMesh) {
  const TetMesh mesh = LayerMesh().make();
  EXPECT_EQ(missed(mesh), "");
  const auto volumes = checks::volumes_with_layers(mesh);
  EXPECT_NEAR(volumes.at(1), LayerMesh::volume_below, 1e-12);
  EXPECT_NEAR(volumes.at(2), LayerMesh::volume_above, 1e-12);
}

TEST(CheckLayerCells, FindsCellsThatFold) {
  TetMesh mesh = LayerMesh().make();
  for (Point& p : mesh.points)
    if (p.z > 0.5) p.z = -0.1;
  EXPECT_NE(missed(mesh).find("layer_jacobian"), std::string::npos);
  mesh = LayerMesh().make();
  std::swap(mesh.layers.prisms[0][1], mesh.layers.prisms[0][2]);
  EXPECT_NE(missed(mesh).find("layer_jacobian"), std::string::npos);
}

TEST(CheckLayerCells, FindsSidesThatDoNotFit) {
  TetMesh mesh = LayerMesh().make();
  mesh.layers.quads.pop_back();
  mesh.layers.quad_regions.pop_back(), mesh.layers.quad_patch.pop_back(), mesh.layers.quad_tag.pop_back();
  EXPECT_EQ(missed(mesh), "layer_sides ");
  mesh = LayerMesh().make();
  std::swap(mesh.layers.quad_regions[0][0], mesh.layers.quad_regions[0][1]);
  EXPECT_EQ(missed(mesh), "layer_sides ");
  mesh = LayerMesh().make();
  mesh.layers.pyramids.push_back(mesh.layers.pyramids[0]);
  mesh.layers.pyramid_region.push_back(2), mesh.layers.pyramid_tag.push_back(LayerMesh::tag_of_region(2));
  mesh.layers.pyramid_layer.push_back(1);
  EXPECT_NE(missed(mesh).find("layer_conforming"), std::string::npos);
}

TEST(CheckLayerCells, FindsArraysThatDoNotFit) {
  TetMesh mesh = LayerMesh().make();
  mesh.layers.prism_tag.pop_back();
  EXPECT_EQ(missed(mesh), "layer_arrays ");
  mesh = LayerMesh().make();
  mesh.layers.prisms[0][0] = static_cast<Index>(mesh.points.size());
  EXPECT_EQ(missed(mesh), "layer_arrays ");
}

TEST(CheckLayerCells, FindsVolumesThatChanged) {
  TetMesh mesh = LayerMesh().make();
  const auto before = checks::volumes_with_layers(mesh);
  CheckReport report;
  checks::check_layer_volumes(before, mesh, {}, report);
  EXPECT_TRUE(report.passed());
  for (Point& p : mesh.points) p.z *= 1.01;
  checks::check_layer_volumes(before, mesh, {}, report);
  EXPECT_EQ(report.findings.size(), 2U);
  report = {};
  checks::check_layer_volumes(before, mesh, {{1, 0.011 * before.at(1)}}, report);
  EXPECT_EQ(report.findings.size(), 1U);
}

}  // namespace
}  // namespace collarmesh::check_layer_cells_test
