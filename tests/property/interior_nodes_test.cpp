// Meshes without a tet that has all corners on surfaces, by brute force over the faces.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "collarmesh/error.h"
#include "collarmesh/pipeline.h"
#include "support/acute_shapes.h"
#include "support/shapes.h"

namespace collarmesh::interior_nodes_test {
namespace {

using namespace testing;

std::size_t tets_on_surfaces(const TetMesh& mesh) {
  const auto on_face = [&mesh](Index v) {
    return std::any_of(mesh.faces.begin(), mesh.faces.end(),
                       [v](const auto& face) { return std::count(face.begin(), face.end(), v) > 0; });
  };
  std::vector<bool> known(mesh.points.size());
  for (Index v = 0; v < mesh.points.size(); ++v) known[v] = on_face(v);
  return static_cast<std::size_t>(std::count_if(mesh.tets.begin(), mesh.tets.end(), [&](const auto& tet) {
    return std::all_of(tet.begin(), tet.end(), [&](Index v) { return known[v]; });
  }));
}

SoupPipelineResult made(const std::vector<PolygonSoup>& soups, double size, bool interior_node,
                        unsigned order = 1) {
  PipelineOptions options;
  options.mesh.size = size;
  options.mesh.bounds.interior_node = interior_node;
  options.order = order;
  return run_pipeline(soups, options);
}

PolygonSoup sheet(double height) {
  PolygonSoup soup;
  soup.points = {{0.2, 0.2, height}, {0.8, 0.2, height}, {0.8, 0.8, height}, {0.2, 0.8, height}};
  soup.add_facet(std::array<Index, 4>{0, 1, 2, 3}, 7);
  return soup;
}

std::vector<std::pair<std::string, std::vector<PolygonSoup>>> shapes() {
  return {{"cube", {box({0, 0, 0}, {1, 1, 1})}},
          {"plate", {box({0, 0, 0}, {3, 2, 0.05})}},
          {"bar", {box({0, 0, 0}, {3, 0.1, 0.1})}},
          {"cube with two sheets", {box({0, 0, 0}, {1, 1, 1}), sheet(0.5), sheet(0.55)}},
          {"two cubes", {box({0, 0, 0}, {1, 1, 1}), box({1, 0, 0}, {2, 1, 1})}},
          {"wedge of 30 degrees", acute::wedge(30).soups},
          {"wedge of 5 degrees", acute::wedge(5).soups},
          {"fan", acute::fan(8).soups},
          {"sectors", acute::sectors(12).soups},
          {"needle", acute::pyramid(7, 10).soups},
          {"star", acute::star_prism(9, 0.4).soups},
          {"spikes", acute::spiked_octahedron(2).soups},
          {"knife", acute::knife(15).soups},
          {"facet that ends inside", acute::facet_ending_inside(20).soups},
          {"tetrahedron", acute::random_tetrahedron(3).soups},
          {"lens", acute::lens(20).soups}};
}

TEST(InteriorNodes, AreThereInEachTet) {
  for (const auto& [name, soups] : shapes()) {
    SCOPED_TRACE(name);
    const SoupPipelineResult of = made(soups, 0.3, true);
    EXPECT_TRUE(of.guarantees_hold()) << of.missed();
    EXPECT_EQ(tets_on_surfaces(of.result.mesh), 0U);
    EXPECT_EQ(of.check.surface_tets, 0U);
    ASSERT_TRUE(of.interior_nodes);
    EXPECT_EQ(of.interior_nodes->remaining, 0U);
    EXPECT_GT(of.interior_nodes->found, 0U);
  }
}

TEST(InteriorNodes, AreThereInSecondOrder) {
  for (const auto& soups : {acute::lens(20).soups, acute::wedge(30).soups}) {
    const SoupPipelineResult of = made(soups, 0.3, true, 2);
    EXPECT_TRUE(of.guarantees_hold()) << of.missed();
    EXPECT_EQ(tets_on_surfaces(of.result.mesh), 0U);
  }
}

TEST(InteriorNodes, AreMissedWhereTheyWereNotAskedFor) {
  const SoupPipelineResult of = made({box({0, 0, 0}, {3, 2, 0.05})}, 0.3, false);
  const std::size_t found = tets_on_surfaces(of.result.mesh);
  ASSERT_GT(found, 0U);
  EXPECT_FALSE(of.interior_nodes);
  EXPECT_EQ(of.check.surface_tets, found);
  Bounds bounds;
  bounds.interior_node = true;
  const CheckReport report = check(of.result.mesh, of.plc, {.bounds = bounds});
  EXPECT_EQ(report.findings_total, found);
  for (const Finding& finding : report.findings) EXPECT_EQ(finding.guarantee, "interior_node");
}

// Nodes on a line inside are not on a surface.
TEST(InteriorNodes, MayLieOnLinesInside) {
  PolygonSoup line;
  line.points = {{0.2, 0.5, 0.5}, {0.8, 0.5, 0.5}};
  line.add_facet(std::array<Index, 2>{0, 1}, 5);
  const SoupPipelineResult of = made({box({0, 0, 0}, {1, 1, 1}), line}, 0.3, true);
  EXPECT_TRUE(of.guarantees_hold()) << of.missed();
  EXPECT_EQ(tets_on_surfaces(of.result.mesh), 0U);
}

TEST(InteriorNodes, NeedACoarsenedMesh) {
  PipelineOptions options;
  options.mesh.bounds.interior_node = true;
  options.coarsen = false;
  const std::vector<PolygonSoup> soups{box({0, 0, 0}, {1, 1, 1})};
  EXPECT_THROW(run_pipeline(soups, options), OptionError);
}

}  // namespace
}  // namespace collarmesh::interior_nodes_test
