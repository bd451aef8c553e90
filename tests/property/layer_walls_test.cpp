// The guarantee on layers beside their walls: meshes as they are made pass, broken ones are found.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "check/layer_walls.h"
#include "collarmesh/pipeline.h"
#include "layers/wall_choice.h"
#include "support/plc_shapes.h"

namespace collarmesh::layer_walls_test {
namespace {

using namespace testing;

class LayerWalls : public ::testing::Test {
 protected:
  /// Makes a mesh, and adds layers to it.
  void make(const std::vector<PolygonSoup>& soups, const std::string& text, bool tets = false,
            int order = 1) {
    PipelineOptions options;
    options.mesh.size = 0.25;
    options.order = order;
    SoupPipelineResult run = run_pipeline(soups, options);
    ASSERT_EQ(run.result.status, MeshStatus::complete);
    const LayerOptions asked{.walls = {text}, .tets = tets};
    walls_ = layering::WallChoice(asked, run.plc).counts(run.plc);
    before_ = run.result.mesh;
    mesh_ = run.result.mesh;
    report_ = make_layers(mesh_, run.plc, asked, improve_options(2));
    ASSERT_GT(report_.coverage(), 0);
  }

  CheckReport check(const TetMesh& mesh) const {
    CheckReport report;
    checks::check_layer_walls(walls_, checks::WallGeometry(before_, walls_), mesh, report_, report);
    return report;
  }

  void expect_found(const TetMesh& mesh, const std::string& text) const {
    const CheckReport report = check(mesh);
    EXPECT_TRUE(std::any_of(report.findings.begin(), report.findings.end(),
                            [&](const Finding& finding) {
                              return finding.guarantee == guarantee::layer_walls &&
                                     finding.message.find(text) != std::string::npos;
                            }))
        << text << ", but "
        << (report.findings.empty() ? "nothing is found" : report.findings.front().message);
  }

  void expect_right() const {
    const CheckReport report = check(mesh_);
    EXPECT_TRUE(report.passed()) << (report.findings.empty() ? "" : report.findings.front().message);
  }

  static void remove_prism(TetMesh& mesh, std::size_t prism) {
    const auto erase = [&](auto& list) { list.erase(list.begin() + static_cast<std::ptrdiff_t>(prism)); };
    erase(mesh.layers.prisms), erase(mesh.layers.prism_region), erase(mesh.layers.prism_tag);
    erase(mesh.layers.prism_layer);
  }

  checks::AskedWalls walls_;
  TetMesh before_, mesh_;
  LayersReport report_;
};

std::vector<PolygonSoup> cube() { return {polygonal_box({0, 0, 0}, {1, 1, 1})}; }

/// A wedge, at whose sharp edge layers end in pyramids and tets.
std::vector<PolygonSoup> wedge() {
  PolygonSoup soup;
  for (const double z : {0.0, 1.0}) {
    soup.points.push_back({0, 0, z});
    soup.points.push_back({2, 0, z});
    soup.points.push_back({1.98, 0.28, z});
  }
  soup.add_facet(std::array<Index, 3>{0, 2, 1}, 1);
  soup.add_facet(std::array<Index, 3>{3, 4, 5}, 2);
  soup.add_facet(std::array<Index, 4>{0, 1, 4, 3}, 3);
  soup.add_facet(std::array<Index, 4>{1, 2, 5, 4}, 4);
  soup.add_facet(std::array<Index, 4>{2, 0, 3, 5}, 5);
  return {soup};
}

TEST_F(LayerWalls, HoldForWhatIsMade) {
  for (const bool tets : {false, true}) {
    for (const char* text : {"all:first=0.02,count=3", "1,3:first=0.02,count=2"}) {
      make(cube(), text, tets);
      expect_right();
    }
    make(wedge(), "all", tets);
    EXPECT_LT(report_.coverage(), 1);
    expect_right();
    make({polygonal_box({0, 0, 0}, {1, 1, 1}), polygonal_box({1, 0, 0}, {2, 1, 1})}, "all:first=0.02", tets);
    expect_right();
    make({sphere(6, 1, {0, 0, 0})}, "all", tets, 2);
    expect_right();
  }
}

TEST_F(LayerWalls, HoldOnBothSidesOfAFacetInside) {
  PolygonSoup soup = polygonal_box({0, 0, 0}, {1, 1, 1});
  const auto first = static_cast<Index>(soup.points.size());
  for (const auto& [x, y] : {std::pair{0.0, 0.0}, {1.0, 0.0}, {1.0, 1.0}, {0.0, 1.0}})
    soup.points.push_back({x, y, 0.5});
  soup.add_facet(std::array<Index, 4>{first, first + 1, first + 2, first + 3}, 7);
  make({soup}, "7:first=0.02,count=2");
  expect_right();
}

TEST_F(LayerWalls, AMissingPrismIsFound) {
  make(cube(), "all:first=0.02,count=3");
  for (const std::uint16_t layer : {1, 2, 3}) {
    TetMesh mesh = mesh_;
    const auto prism = std::find(mesh.layers.prism_layer.begin(), mesh.layers.prism_layer.end(), layer);
    remove_prism(mesh, static_cast<std::size_t>(prism - mesh.layers.prism_layer.begin()));
    expect_found(mesh, "has cells in one layer that differ from those in the first layer");
  }
  // If all three layers above a triangle are missing, less is covered than the report says.
  TetMesh mesh = mesh_;
  const auto wall_of = [&](std::size_t prism) {
    std::array<Index, 3> below{};
    for (unsigned k = 0; k < 3; ++k) below[k] = report_.walls[mesh.layers.prisms[prism][k]];
    std::sort(below.begin(), below.end());
    return below;
  };
  const auto below = wall_of(0);
  for (std::size_t p = mesh.layers.prisms.size(); p-- > 0;)
    if (wall_of(p) == below) remove_prism(mesh, p);
  EXPECT_EQ(mesh.layers.prisms.size() + 3, mesh_.layers.prisms.size());
  expect_found(mesh, "but the report says");
}

TEST_F(LayerWalls, AWallThatMovesIsFound) {
  make(cube(), "1:first=0.02,count=2");
  TetMesh mesh = mesh_;
  const auto face = static_cast<std::size_t>(std::find(mesh.face_tag.begin(), mesh.face_tag.end(), 1) -
                                             mesh.face_tag.begin());
  Point& p = mesh.points[mesh.faces[face][0]];
  p = p + Vector{1e-12, 0, 0};
  expect_found(mesh, "The triangle of a wall at");
  mesh = mesh_;
  std::swap(mesh.faces[face][0], mesh.faces[face][1]);
  expect_found(mesh, "The triangle of a wall at");
  mesh = mesh_;
  mesh.edges.clear();
  expect_found(mesh, "The edge of a wall at");
}

TEST_F(LayerWalls, CellsWithoutAWallAreFound) {
  make(cube(), "1:first=0.02,count=2");
  TetMesh mesh = mesh_;
  mesh.layers.prism_layer[0] = 9;
  expect_found(mesh, "has a cell in a layer that was not asked for");
  mesh = mesh_;
  mesh.layers.prism_region[0] = 5;
  expect_found(mesh, "lies on no triangle on which layers were asked for");
  mesh = mesh_;
  mesh.layers.tet_layer[0] = 1;  // this tet belongs to the core
  expect_found(mesh, "lies on no triangle on which layers were asked for");
  mesh = mesh_;
  mesh.layers.prisms.push_back(mesh.layers.prisms[0]);
  mesh.layers.prism_region.push_back(mesh.layers.prism_region[0]);
  mesh.layers.prism_tag.push_back(mesh.layers.prism_tag[0]);
  mesh.layers.prism_layer.push_back(mesh.layers.prism_layer[0]);
  expect_found(mesh, mesh.layers.prism_layer[0] == 1 ? "in the first layer" : "has cells in one layer");
  // Layers on a face for which none were asked.
  walls_.clear();
  expect_found(mesh_, "lies on no triangle on which layers were asked for");
}

TEST_F(LayerWalls, AWrongReportIsFound) {
  make(wedge(), "all");
  ASSERT_FALSE(report_.patches.empty());
  report_.patches[0].covered *= 1.01;
  expect_found(mesh_, "but the report says");
  report_.patches[0].covered /= 1.01;
  report_.patches[0].area += 0.01;
  expect_found(mesh_, "but the report says");
  report_.walls.clear();
  expect_found(mesh_, "lies on no triangle on which layers were asked for");
}

}  // namespace
}  // namespace collarmesh::layer_walls_test
