// A box around inputs that enclose nothing (points, segments, single facets), and around others.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <vector>

#include "collarmesh/pipeline.h"
#include "support/meshing.h"
#include "support/shapes.h"

namespace collarmesh::box_domain_test {
namespace {

const PlcOptions in_box{.domain = DomainShape::box};

SoupPipelineResult made_of(const std::vector<PolygonSoup>& soups) {
  PipelineOptions options;
  options.complex = in_box;
  return run_pipeline(soups, options);
}

double volume(const Box& box) {
  const Vector sides = box.max - box.min;
  return sides.x * sides.y * sides.z;
}

// Expects a region of tets between the box and its contents, in addition to the regions without the box.
void expect_box_of(const SoupPipelineResult& made, const Box& inner, Index regions) {
  EXPECT_TRUE(made.guarantees_hold()) << made.missed();
  ASSERT_EQ(made.plc.regions.size(), regions + 1);
  const Vector sides = inner.max - inner.min;
  const double margin = std::max({sides.x, sides.y, sides.z});
  const double all =
      volume({inner.min - Vector{margin, margin, margin}, inner.max + Vector{margin, margin, margin}});
  double sum = 0;
  for (const double v : made.check.region_volumes) sum += v;
  EXPECT_NEAR(sum, all, 1e-9 * all);
}

PolygonSoup wire(const std::vector<Point>& points) {
  PolygonSoup soup;
  soup.points = points;
  for (Index i = 0; i + 1 < points.size(); ++i) soup.segments.push_back({i, i + 1, 5});
  return soup;
}

TEST(BoxDomain, HoldsPoints) {
  PolygonSoup points;
  points.points = {{0, 0, 0}, {1, 0, 0}, {0.3, 0.7, 0.2}, {0.3, 0.7, 0.21}};
  const SoupPipelineResult made = made_of({points});
  expect_box_of(made, Box{{0, 0, 0}, {1, 0.7, 0.21}}, 1);
  for (const Point& p : points.points) EXPECT_TRUE(testing::has_vertex_at(made.result.mesh, p));
}

TEST(BoxDomain, HoldsOnePoint) {
  PolygonSoup point;
  point.points = {{5, 5, 5}};
  const SoupPipelineResult made = made_of({point});
  EXPECT_TRUE(made.guarantees_hold()) << made.missed();
  EXPECT_TRUE(testing::has_vertex_at(made.result.mesh, {5, 5, 5}));
}

TEST(BoxDomain, HoldsWires) {
  const SoupPipelineResult made = made_of({wire({{0, 0, 0}, {1, 0, 0}, {0.2, 0.3, 0}, {0.2, 0.3, 1}})});
  expect_box_of(made, Box{{0, 0, 0}, {1, 0.3, 1}}, 1);
  double length = 0;
  const TetMesh& mesh = made.result.mesh;
  for (Index e = 0; e < mesh.edges.size(); ++e)
    if (mesh.edge_tag[e] == 5)
      length += distance(mesh.points[mesh.edges[e][0]], mesh.points[mesh.edges[e][1]]);
  EXPECT_NEAR(length, 1 + std::hypot(0.8, 0.3) + 1, 1e-9);
}

TEST(BoxDomain, HoldsAFacet) {
  PolygonSoup facet;
  facet.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  facet.add_facet(std::vector<Index>{0, 1, 2, 3}, 7);
  const SoupPipelineResult made = made_of({facet});
  expect_box_of(made, Box{{0, 0, 0}, {1, 1, 0}}, 1);
  double area = 0;
  std::set<Tag> tags;
  const TetMesh& mesh = made.result.mesh;
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    tags.insert(mesh.face_tag[f]);
    if (mesh.face_tag[f] != 7) continue;
    const auto& [a, b, c] = mesh.faces[f];
    area += 0.5 * norm(cross(mesh.points[b] - mesh.points[a], mesh.points[c] - mesh.points[a]));
  }
  EXPECT_NEAR(area, 1, 1e-9);
  EXPECT_EQ(tags, (std::set<Tag>{7, 8})) << "the box has a tag of its own";
}

TEST(BoxDomain, IsTheLastRegionAroundSolids) {
  const SoupPipelineResult made =
      made_of({testing::box({0, 0, 0}, {1, 1, 1}), testing::box({2, 0, 0}, {3, 1, 1})});
  expect_box_of(made, Box{{0, 0, 0}, {3, 1, 1}}, 3);
  ASSERT_EQ(made.check.region_volumes.size(), 4U);
  EXPECT_NEAR(made.check.region_volumes[1], 1, 1e-9);
  EXPECT_NEAR(made.check.region_volumes[2], 1, 1e-9);
}

TEST(BoxDomain, IsAsFarAwayAsAskedFor) {
  const std::vector<PolygonSoup> soups{wire({{0, 0, 0}, {2, 0, 0}})};
  for (const double margin : {0.1, 3.0}) {
    PlcOptions options = in_box;
    options.box_margin = margin;
    const Plc plc = build_plc(soups, options);
    EXPECT_NEAR(plc.bounds.min.x, -2 * margin, 1e-9);
    EXPECT_NEAR(plc.bounds.max.y, 2 * margin, 1e-9);
  }
}

TEST(BoxDomain, IsThereOnRequestOnly) {
  EXPECT_THROW(build_plc(std::vector{wire({{0, 0, 0}, {1, 0, 0}})}), PlcError);
  EXPECT_THROW(build_plc(std::vector{PolygonSoup()}, in_box), PlcError) << "there is nothing to put in it";
}

}  // namespace
}  // namespace collarmesh::box_domain_test
