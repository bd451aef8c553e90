// Periodic faces, by brute force: nodes, edges and triangles of one side, moved, are those of the other side.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "collarmesh/error.h"
#include "collarmesh/pipeline.h"
#include "support/periodic.h"
#include "support/plc_shapes.h"

namespace collarmesh::periodic_test {
namespace {

using namespace testing;

PipelineResult mesh_of_soups(const std::vector<PolygonSoup>& soups, const std::vector<std::string>& pairs,
                             double size, unsigned order = 1) {
  PipelineOptions options;
  options.mesh.size = size;
  options.order = order;
  options.periodic.pairs = pairs;
  return run_pipeline(soups, options);
}

/// The nodes and triangles in a plane x, y or z = place, as points without that coordinate.
struct Side {
  std::vector<std::array<double, 2>> nodes;
  std::vector<std::array<std::array<double, 2>, 3>> triangles;
};

Side side_of(const TetMesh& mesh, std::size_t axis, double place) {
  const auto flat = [&](Index v) {
    const Point& p = mesh.points[v];
    return std::array{p[(axis + 1) % 3], p[(axis + 2) % 3]};
  };
  Side side;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const auto& corners = mesh.faces[f];
    if (mesh.face_regions[f][1] != 0 || std::ranges::any_of(corners, [&](Index v) {
          return std::fabs(mesh.points[v][axis] - place) > 1e-12;
        }))
      continue;
    std::array<std::array<double, 2>, 3> triangle{flat(corners[0]), flat(corners[1]), flat(corners[2])};
    std::sort(triangle.begin(), triangle.end());
    side.triangles.push_back(triangle);
    side.nodes.insert(side.nodes.end(), triangle.begin(), triangle.end());
    if (mesh.order() == 2)
      for (const Index v : mesh.face_mid_nodes[f]) side.nodes.push_back(flat(v));
  }
  std::sort(side.triangles.begin(), side.triangles.end());
  std::sort(side.nodes.begin(), side.nodes.end());
  side.nodes.erase(std::unique(side.nodes.begin(), side.nodes.end()), side.nodes.end());
  return side;
}

/// Expects equal sides at both ends of the unit cube along an axis. Coordinates are equal numbers, because
/// the shift is exact.
void expect_alike(const TetMesh& mesh, std::size_t axis) {
  const Side low = side_of(mesh, axis, 0), high = side_of(mesh, axis, 1);
  EXPECT_GT(low.triangles.size(), 10U);
  EXPECT_EQ(low.nodes, high.nodes);
  EXPECT_EQ(low.triangles, high.triangles);
}

TEST(PeriodicFaces, OfABoxAreImagesInAllDirections) {
  for (const double size : {0.3, 0.12}) {
    const PipelineResult made = mesh_of_soups({polygonal_box({0, 0, 0}, {1, 1, 1})}, {"x", "y", "z"}, size);
    ASSERT_TRUE(made.guarantees_hold()) << made.missed();
    for (std::size_t axis = 0; axis < 3; ++axis) expect_alike(made.result.mesh, axis);
    ASSERT_EQ(made.result.mesh.periodic.size(), 3U);
    for (const auto& faces : made.result.mesh.periodic)
      for (const auto& [node, image] : faces.nodes)
        EXPECT_EQ(faces.motion(made.result.mesh.points[node]), made.result.mesh.points[image]);
  }
}

TEST(PeriodicFaces, HaveMidEdgeNodesThatAreImages) {
  const PipelineResult made = mesh_of_soups({polygonal_box({0, 0, 0}, {1, 1, 1})}, {"x", "z"}, 0.3, 2);
  ASSERT_TRUE(made.guarantees_hold()) << made.missed();
  expect_alike(made.result.mesh, 0);
  expect_alike(made.result.mesh, 2);
}

// The faces cut regions, along edges and at corners, too.
TEST(PeriodicFaces, AreCutByRegions) {
  const PipelineResult made = mesh_of_soups({cell_of_boxes({0, 0.15, 0.7, 1})}, {"x", "y", "z"}, 0.15);
  ASSERT_TRUE(made.guarantees_hold()) << made.missed();
  EXPECT_EQ(*std::ranges::max_element(made.result.mesh.tet_region), 27U);
  for (std::size_t axis = 0; axis < 3; ++axis) expect_alike(made.result.mesh, axis);
}

/// The unit cube with two patches side by side at either end of x: 1 and 3 at the low end.
PolygonSoup cube_with_divided_ends() {
  PolygonSoup soup;
  soup.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0},   {1, 1, 0},   {0, 0, 1},   {1, 0, 1},
                 {0, 1, 1}, {1, 1, 1}, {0, 0.5, 0}, {1, 0.5, 0}, {0, 0.5, 1}, {1, 0.5, 1}};
  const auto add = [&soup](Tag tag, std::vector<Index> corners) { soup.add_facet(corners, tag); };
  add(1, {0, 4, 10, 8}), add(3, {8, 10, 6, 2});
  add(2, {1, 9, 11, 5}), add(4, {9, 3, 7, 11});
  add(5, {0, 1, 5, 4}), add(6, {2, 6, 7, 3});
  add(7, {0, 8, 2, 3, 9, 1}), add(8, {4, 5, 11, 7, 6, 10});
  return soup;
}

// The curve between both patches of an end is an image by one pair, and has an image by the other.
TEST(PeriodicFaces, MayHavePairsInOppositeDirections) {
  for (const char* second : {"3=4", "4=3"})
    for (const double size : {0.7, 0.3, 0.15}) {
      const PipelineResult made = mesh_of_soups({cube_with_divided_ends()}, {"1=2", second}, size);
      EXPECT_TRUE(made.guarantees_hold()) << second << " " << size << " " << made.missed();
      if (size < 0.5) expect_alike(made.result.mesh, 0);
    }
}

/// A quarter of a ring or of a disk about the z axis. Patch 1 lies in y = 0 and patch 2 in x = 0.
PolygonSoup sector(double inner) {
  constexpr unsigned steps = 6;
  std::vector<std::array<double, 2>> outline;
  for (unsigned i = 0; i <= steps; ++i) {
    const double angle = std::acos(0.0) * i / steps;
    outline.push_back({i == steps ? 0 : std::cos(angle), i == 0 ? 0 : std::sin(angle)});
  }
  if (inner == 0)
    outline.push_back({0, 0});
  else
    for (unsigned i = 0; i <= steps; ++i) {
      const auto [x, y] = outline[steps - i];
      outline.push_back({inner * x, inner * y});
    }
  PolygonSoup soup;
  std::vector<Index> bottom, top;
  for (const auto& [x, y] : outline)
    for (const double z : {0.0, 0.4}) soup.points.push_back({x, y, z});
  const auto n = static_cast<Index>(outline.size());
  for (Index i = 0; i < n; ++i) bottom.insert(bottom.begin(), 2 * i), top.push_back(2 * i + 1);
  soup.add_facet(bottom, 3), soup.add_facet(top, 4);
  for (Index i = 0; i < n; ++i) {
    const Index j = (i + 1) % n;
    const auto is_zero = [&](unsigned axis) { return outline[i][axis] == 0 && outline[j][axis] == 0; };
    const std::vector<Index> side{2 * i, 2 * j, 2 * j + 1, 2 * i + 1};
    soup.add_facet(side, is_zero(1) ? 1 : is_zero(0) ? 2 : 5);
  }
  return soup;
}

// With and without nodes on the axis, which are their own images.
TEST(PeriodicFaces, OfASectorAreTurned) {
  for (const double inner : {0.0, 0.5})
    for (const unsigned order : {1U, 2U}) {
      const PipelineResult made = mesh_of_soups({sector(inner)}, {"1=2:rotation,z,90"}, 0.12, order);
      ASSERT_TRUE(made.guarantees_hold()) << made.missed();
      const TetMesh& mesh = made.result.mesh;
      const Side first = side_of(mesh, 1, 0), second = side_of(mesh, 0, 0);
      // Coordinates in y = 0 are z and x, in x = 0 y and z; a node at (x, 0, z) is turned to (0, x, z).
      std::set<std::array<double, 2>> turned;
      for (const auto& [z, x] : first.nodes) turned.insert({x, z});
      EXPECT_GT(turned.size(), 10U);
      EXPECT_EQ(turned, std::set(second.nodes.begin(), second.nodes.end()));
      EXPECT_EQ(first.triangles.size(), second.triangles.size());
    }
}

TEST(PeriodicFaces, DoNotDependOnThreads) {
  PipelineOptions options;
  options.mesh.size = 0.15;
  options.periodic.pairs = {"x", "y", "z"};
  std::vector<TetMesh> made;
  for (const unsigned threads : {1U, 2U}) {
    options.mesh.threads = threads;
    made.push_back(run_pipeline(std::vector{polygonal_box({0, 0, 0}, {1, 1, 1})}, options).result.mesh);
  }
  EXPECT_EQ(made[0].points, made[1].points);
  EXPECT_EQ(made[0].tets, made[1].tets);
}

TEST(PeriodicFaces, CostFewElements) {
  std::size_t with = 0, without = 0;
  for (const double size : {0.2, 0.1, 0.07}) {
    without += mesh_of_soups({polygonal_box({0, 0, 0}, {1, 1, 1})}, {}, size).result.mesh.tets.size();
    with +=
        mesh_of_soups({polygonal_box({0, 0, 0}, {1, 1, 1})}, {"x", "y", "z"}, size).result.mesh.tets.size();
  }
  EXPECT_LT(static_cast<double>(with), 1.1 * static_cast<double>(without));
}

TEST(PeriodicFaces, ThatAreNoImagesAreRefused) {
  const auto refusal = [](const std::string& pair, const std::vector<PolygonSoup>& soups) {
    try {
      mesh_of_soups(soups, {pair}, 0.3);
    } catch (const OptionError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  const std::vector<PolygonSoup> cube{polygonal_box({0, 0, 0}, {1, 1, 1})};
  std::vector<std::string> many(33, "x");
  EXPECT_THROW(mesh_of_soups(cube, many, 0.3), OptionError);
  EXPECT_NE(refusal("nowhere=1", cube).find("'nowhere'"), std::string::npos);
  EXPECT_NE(refusal("1:2", cube).find("FIRST=SECOND"), std::string::npos);
  EXPECT_NE(refusal("1=2:translation,one,0,0", cube).find("'one' is no number"), std::string::npos);
  PolygonSoup tapered = cube[0];
  for (Point& p : tapered.points)
    if (p.x == 1) p.y *= 0.5;
  EXPECT_NE(refusal("x", {tapered}).find("images of each other"), std::string::npos)
      << refusal("x", {tapered});
  EXPECT_NE(refusal("x", {wedge(30, 1)}).find("no planar patch lies at the low end"), std::string::npos);
}

}  // namespace
}  // namespace collarmesh::periodic_test
