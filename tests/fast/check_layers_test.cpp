// The certificate of meshes with prisms, pyramids and quadrangles: right ones pass, wrong ones are found.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "collarmesh/check.h"
#include "collarmesh/error.h"
#include "collarmesh/locate.h"
#include "collarmesh/partition.h"
#include "collarmesh/plc_builder.h"
#include "collarmesh/size_field.h"
#include "common/layer_tets.h"
#include "support/layer_mesh.h"
#include "support/second_order.h"

namespace collarmesh::check_layers_test {
namespace {

using testing::layer_mesh;
using testing::second_order;

/// Returns the complex that the mesh's own faces make.
Plc complex_of(const TetMesh& mesh) {
  PolygonSoup soup;
  soup.points.assign(mesh.points.begin(), mesh.points.begin() + 19);
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) soup.add_facet(mesh.faces[f], mesh.face_tag[f]);
  for (std::size_t f = 0; f < mesh.layers.quads.size(); ++f)
    soup.add_facet(mesh.layers.quads[f], mesh.layers.quad_tag[f]);
  soup.region_points.push_back({{0, 0.5, -0.7}, 20, 0});
  soup.region_points.push_back({{0, 0.5, 0.1}, -4, 0});
  return build_plc(std::span(&soup, 1));
}

/// Returns bounds that so coarse a mesh keeps.
CheckOptions loose() {
  CheckOptions options;
  options.bounds.radius_edge = 100;
  options.bounds.thin_angle = 1;
  return options;
}

TetMesh without_features(TetMesh mesh) {
  std::fill(mesh.face_patch.begin(), mesh.face_patch.end(), none);
  std::fill(mesh.layers.quad_patch.begin(), mesh.layers.quad_patch.end(), none);
  mesh.edges.clear();
  mesh.edge_curve.clear();
  mesh.edge_tag.clear();
  mesh.edge_mid_nodes.clear();
  return mesh;
}

std::set<std::string> guarantees(const CheckReport& report) {
  std::set<std::string> names;
  for (const Finding& finding : report.findings) names.insert(finding.guarantee);
  return names;
}

TEST(CheckLayers, PartsOfCellsFit) {
  for (const int order : {1, 2}) {
    const TetMesh mesh = order == 1 ? layer_mesh() : second_order(layer_mesh());
    const TetMesh cut = tets_of_layers(mesh);
    EXPECT_EQ(cut.tets.size(),
              mesh.tets.size() + 3 * mesh.layers.prisms.size() + 2 * mesh.layers.pyramids.size());
    EXPECT_EQ(cut.faces.size(), mesh.faces.size() + 2 * mesh.layers.quads.size());
    double volume = 0;
    std::map<std::array<Index, 3>, int> sides;
    for (const auto& t : cut.tets) {
      const double six = six_volume(cut.points[t[0]], cut.points[t[1]], cut.points[t[2]], cut.points[t[3]]);
      EXPECT_GT(six, 0);
      volume += six / 6;
      for (std::size_t k = 0; k < 4; ++k) {
        std::array<Index, 3> side{t[(k + 1) % 4], t[(k + 2) % 4], t[(k + 3) % 4]};
        std::sort(side.begin(), side.end());
        ++sides[side];
      }
    }
    EXPECT_NEAR(volume, testing::LayerMesh::volume_below + testing::LayerMesh::volume_above, 1e-9);
    std::set<std::array<Index, 3>> listed;
    for (auto face : cut.faces) {
      std::sort(face.begin(), face.end());
      EXPECT_TRUE(listed.insert(face).second);
    }
    for (const auto& [side, count] : sides) EXPECT_TRUE(count == 2 || (count == 1 && listed.contains(side)));
    EXPECT_EQ(cut.order(), order);
    EXPECT_EQ(cut.face_mid_nodes.size(), order == 2 ? cut.faces.size() : 0);
  }
}

TEST(CheckLayers, EdgesOfPrismsLeadToTheWall) {
  const TetMesh mesh = testing::mesh_of_prisms();
  const std::vector<Index> walls = walls_below(mesh);
  for (Index v = 0; v < 9; ++v) {
    EXPECT_EQ(walls[v], none);
    EXPECT_EQ(walls[v + 9], v);
  }
  EXPECT_EQ(walls[18], none);
}

/// Two layers, on one triangle of the wall as tets, on the next one as pyramids.
TetMesh tets_and_pyramids() {
  TetMesh mesh;
  mesh.points = {{0, 0, 0},   {1, 0, 0},   {0, 1, 0},   {-1, 0, 0},
                 {0, 0, 0.1}, {0, 0, 0.2}, {0, 1, 0.1}, {0, 1, 0.2}};
  mesh.faces = {{0, 2, 1}, {0, 3, 2}};
  mesh.tets = {{0, 1, 2, 4}, {4, 1, 2, 5}, {5, 1, 2, 7}};
  mesh.layers.tet_layer = {1, 2, 0};
  mesh.layers.pyramids = {{0, 2, 6, 4, 3}, {4, 6, 7, 5, 3}};
  mesh.layers.pyramid_layer = {1, 2};
  return mesh;
}

TEST(CheckLayers, EdgesOfTetsAndPyramidsLeadToTheWall) {
  const TetMesh mesh = tets_and_pyramids();
  EXPECT_EQ(walls_below(mesh), (std::vector<Index>{none, none, none, none, 0, 0, 2, 2}));
}

TEST(CheckLayers, CellsAboveNoListedTriangleLeadToNoWall) {
  TetMesh mesh = tets_and_pyramids();
  mesh.faces.pop_back();
  EXPECT_EQ(walls_below(mesh), std::vector<Index>(8, none));
  mesh = tets_and_pyramids();
  mesh.layers.pyramids.clear();
  mesh.tets[0] = {1, 2, 4, 0};
  EXPECT_EQ(walls_below(mesh), std::vector<Index>(8, none));
}

TEST(CheckLayers, ARightMeshPasses) {
  for (const int order : {1, 2}) {
    const TetMesh mesh = without_features(order == 1 ? layer_mesh() : second_order(layer_mesh()));
    const CheckReport report = check(mesh, complex_of(mesh), loose());
    for (const Finding& finding : report.findings)
      ADD_FAILURE() << finding.guarantee << ": " << finding.message;
    EXPECT_EQ(report.tets, mesh.tets.size());
    EXPECT_EQ(report.points, mesh.points.size());
    EXPECT_FALSE(report.notes.empty());
  }
}

TEST(CheckLayers, WrongMeshesAreFound) {
  const TetMesh right = without_features(layer_mesh());
  const Plc plc = complex_of(right);
  const auto found = [&](const TetMesh& mesh) { return guarantees(check(mesh, plc, loose())); };
  TetMesh mesh = right;
  std::swap(mesh.layers.prisms[0][0], mesh.layers.prisms[0][1]);
  EXPECT_TRUE(found(mesh).contains("layer_jacobian"));
  mesh = right;
  mesh.layers.quads.pop_back();
  mesh.layers.quad_regions.pop_back();
  mesh.layers.quad_patch.pop_back();
  mesh.layers.quad_tag.pop_back();
  EXPECT_TRUE(found(mesh).contains("layer_sides"));
  mesh = right;
  mesh.layers.pyramid_layer.pop_back();
  EXPECT_TRUE(found(mesh).contains("layer_arrays"));
  mesh = right;
  for (Point& p : mesh.points) p = p + Vector{0.3, 0, 0};
  EXPECT_FALSE(found(mesh).empty());
  // A corner moved outwards: the boundary is no longer that of the complex.
  mesh = right;
  mesh.points[0] = mesh.points[0] + Vector{-0.2, -0.2, 0.1};
  EXPECT_FALSE(found(mesh).empty());
}

TEST(CheckLayers, RegionVolumesCountPrisms) {
  const TetMesh mesh = layer_mesh();
  const MeshMeasures measures = measure_mesh(mesh);
  EXPECT_NEAR(measures.region_volumes.at(1), testing::LayerMesh::volume_below, 1e-9);
  EXPECT_NEAR(measures.region_volumes.at(2), testing::LayerMesh::volume_above, 1e-9);
}

TEST(CheckLayers, WhatTakesTetsAloneSaysSo) {
  TetMesh mesh = layer_mesh();
  EXPECT_THROW(partition(mesh, 2), OptionError);
  EXPECT_THROW(locate(mesh, std::vector<Point>{{0, 0, 0}}), OptionError);
}

TEST(CheckLayers, SizesAreFoundInPrisms) {
  const TetMesh mesh = second_order(layer_mesh());
  std::vector<double> sizes;
  for (const Point& p : mesh.points) sizes.push_back(3 + p.x + 0.5 * p.z);
  const SizeField field = size_field_on_mesh(mesh, sizes);
  for (const Point& p : {Point{0, 0.5, -0.7}, Point{-0.5, 0.4, -0.5}, Point{0.3, 0.3, 0.2}})
    EXPECT_NEAR(field(p), 3 + p.x + 0.5 * p.z, 1e-12);
}

}  // namespace
}  // namespace collarmesh::check_layers_test
