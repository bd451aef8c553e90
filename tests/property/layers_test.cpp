// Boundary layers of shapes: valid cells, walls that stay, heights as asked, judged by formulas of this file.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "check/layer_cells.h"
#include "collarmesh/error.h"
#include "collarmesh/layers.h"
#include "collarmesh/pipeline.h"
#include "common/layer_tets.h"
#include "support/plc_shapes.h"

namespace collarmesh::layers_test {
namespace {

using namespace testing;

constexpr double size = 0.2;

PipelineOptions with_layers(const std::vector<std::string>& walls) {
  PipelineOptions options;
  options.mesh.size = size;
  options.mesh.max_vertices = 200'000;
  options.layers.walls = walls;
  return options;
}

PipelineResult made(const std::vector<PolygonSoup>& soups, const PipelineOptions& options) {
  PipelineResult run = run_pipeline(soups, options);
  EXPECT_EQ(run.result.status, MeshStatus::complete) << run.missed();
  EXPECT_TRUE(run.check.passed()) << run.missed();
  EXPECT_TRUE(run.layers.has_value());
  return run;
}

double volume(const Point& a, const Point& b, const Point& c, const Point& d) {
  return dot(cross(b - a, c - a), d - a) / 6;
}

/// Returns the volume of all cells; for prisms and pyramids the mean over both diagonals of each quadrangle.
double volume_of(const TetMesh& mesh) {
  double sum = 0;
  const auto& p = mesh.points;
  for (const auto& [a, b, c, d] : mesh.tets) sum += volume(p[a], p[b], p[c], p[d]);
  // By the divergence theorem: a sum over sides, as seen from the origin.
  const auto side = [&](Index a, Index b, Index c) { return dot(cross(p[a], p[b]), p[c]) / 6; };
  const auto quad = [&](Index a, Index b, Index c, Index d) {
    return 0.5 * (side(a, b, c) + side(a, c, d) + side(a, b, d) + side(b, c, d));
  };
  for (const auto& [a, b, c, d, e, f] : mesh.layers.prisms)
    sum += side(a, c, b) + side(d, e, f) + quad(a, b, e, d) + quad(b, c, f, e) + quad(c, a, d, f);
  for (const auto& [a, b, c, d, e] : mesh.layers.pyramids)
    sum += quad(a, d, c, b) + side(a, b, e) + side(b, c, e) + side(c, d, e) + side(d, a, e);
  return sum;
}

/// Returns the smallest corner Jacobian of all cells.
double least_jacobian_of(const TetMesh& mesh) {
  double least = INFINITY;
  const auto& p = mesh.points;
  const auto see = [&](Index a, Index b, Index c, Index d) {
    least = std::min(least, volume(p[a], p[b], p[c], p[d]));
  };
  for (const auto& [a, b, c, d] : mesh.tets) see(a, b, c, d);
  for (const auto& v : mesh.layers.prisms)
    for (unsigned i = 0; i < 3; ++i) {
      const unsigned j = (i + 1) % 3, k = (i + 2) % 3;
      see(v[i], v[j], v[k], v[i + 3]);
      see(v[i + 3], v[k + 3], v[j + 3], v[i]);
    }
  for (const auto& v : mesh.layers.pyramids)
    for (unsigned i = 0; i < 4; ++i) see(v[i], v[(i + 1) % 4], v[(i + 3) % 4], v[4]);
  return least;
}

std::set<std::array<Point, 3>, bool (*)(const std::array<Point, 3>&, const std::array<Point, 3>&)>
triangles_of(const TetMesh& mesh, Tag tag) {
  const auto less = [](const std::array<Point, 3>& s, const std::array<Point, 3>& t) {
    for (unsigned i = 0; i < 3; ++i)
      for (unsigned axis = 0; axis < 3; ++axis)
        if (s[i][axis] != t[i][axis]) return s[i][axis] < t[i][axis];
    return false;
  };
  std::set<std::array<Point, 3>, bool (*)(const std::array<Point, 3>&, const std::array<Point, 3>&)> found(
      less);
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    if (tag != 0 && mesh.face_tag[f] != tag) continue;
    std::array<Point, 3> t{mesh.points[mesh.faces[f][0]], mesh.points[mesh.faces[f][1]],
                           mesh.points[mesh.faces[f][2]]};
    std::sort(t.begin(), t.end(), [](const Point& a, const Point& b) {
      return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z < b.z;
    });
    found.insert(t);
  }
  return found;
}

/// A wedge whose faces of length 2 meet at this angle, in degrees.
PolygonSoup wedge(double degrees) {
  const double angle = degrees * M_PI / 180;
  PolygonSoup soup;
  for (const double z : {0.0, 1.0})
    for (const auto& [x, y] : {std::array{0.0, 0.0}, {2.0, 0.0}, {2 * std::cos(angle), 2 * std::sin(angle)}})
      soup.points.push_back({x, y, z});
  soup.add_facet(std::array<Index, 3>{0, 2, 1}, 1);
  soup.add_facet(std::array<Index, 3>{3, 4, 5}, 2);
  soup.add_facet(std::array<Index, 4>{0, 1, 4, 3}, 3);
  soup.add_facet(std::array<Index, 4>{1, 2, 5, 4}, 4);
  soup.add_facet(std::array<Index, 4>{2, 0, 3, 5}, 5);
  return soup;
}

TEST(Layers, CoverACubeWithPrismsAsHighAsAsked) {
  const std::vector<PolygonSoup> soups{polygonal_box({0, 0, 0}, {1, 1, 1})};
  const PipelineResult run = made(soups, with_layers({"all:first=0.02,growth=1.5,count=3"}));
  const TetMesh& mesh = run.result.mesh;
  EXPECT_GT(run.layers->prisms, 0U);
  EXPECT_NEAR(run.layers->coverage(), 1, 1e-9);
  EXPECT_LE(run.layers->largest_step, 2 + 1e-6);
  EXPECT_GT(least_jacobian_of(mesh), 0);
  EXPECT_NEAR(volume_of(mesh), 1, 1e-9);
  // First layers end 0.02 above their faces, third ones 0.095, unless layers are lowered.
  std::size_t full = 0, all = 0;
  for (std::size_t i = 0; i < mesh.layers.prisms.size(); ++i) {
    if (mesh.layers.prism_layer[i] != 1) continue;
    ++all;
    double height = 0;
    for (unsigned k = 3; k < 6; ++k) {
      const Point& p = mesh.points[mesh.layers.prisms[i][k]];
      height = std::max(height, std::min({p.x, p.y, p.z, 1 - p.x, 1 - p.y, 1 - p.z}));
    }
    EXPECT_LE(height, 0.02 + 1e-9);
    if (height > 0.02 * 0.95) ++full;
  }
  EXPECT_GT(full, all * 9 / 10);
}

TEST(Layers, KeepTheTrianglesOfWalls) {
  const SoupPipelineResult without =
      run_pipeline(std::vector<PolygonSoup>{polygonal_box({0, 0, 0}, {1, 1, 1})}, with_layers({}));
  TetMesh mesh = without.result.mesh;
  const LayersReport report = make_layers(mesh, without.plc, {.walls = {"all"}}, improve_options(2));
  EXPECT_GT(report.prisms, 0U);
  EXPECT_EQ(triangles_of(mesh, 0), triangles_of(without.result.mesh, 0));
}

TEST(Layers, AreTheSameForAnyNumberOfThreads) {
  for (const auto& soup : {sphere(6, 1, {0, 0, 0}), wedge(20)}) {
    PipelineOptions options = with_layers({"all"});
    options.mesh.threads = 1;
    const PipelineResult one = made({soup}, options);
    for (const unsigned threads : {2U, 3U, 4U}) {
      options.mesh.threads = threads;
      const PipelineResult more = made({soup}, options);
      EXPECT_EQ(one.result.mesh.points, more.result.mesh.points) << threads;
      EXPECT_EQ(one.result.mesh.tets, more.result.mesh.tets) << threads;
      EXPECT_EQ(one.result.mesh.layers.prisms, more.result.mesh.layers.prisms) << threads;
      EXPECT_EQ(one.result.mesh.layers.pyramids, more.result.mesh.layers.pyramids) << threads;
    }
  }
}

TEST(Layers, OnOneFaceEndAtTheOthersInQuadrangles) {
  const std::vector<PolygonSoup> soups{polygonal_box({0, 0, 0}, {1, 1, 1})};
  const PipelineResult run = made(soups, with_layers({"1:first=0.02,count=2"}));
  const TetMesh& mesh = run.result.mesh;
  EXPECT_GT(mesh.layers.quads.size(), 0U);
  EXPECT_NEAR(run.layers->coverage(), 1, 1e-9);
  EXPECT_GT(least_jacobian_of(mesh), 0);
  EXPECT_NEAR(volume_of(mesh), 1, 1e-9);
  std::map<Tag, double> areas;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const auto& [a, b, c] = mesh.faces[f];
    areas[mesh.face_tag[f]] +=
        0.5 * norm(cross(mesh.points[b] - mesh.points[a], mesh.points[c] - mesh.points[a]));
  }
  for (std::size_t q = 0; q < mesh.layers.quads.size(); ++q) {
    const auto& [a, b, c, d] = mesh.layers.quads[q];
    areas[mesh.layers.quad_tag[q]] +=
        0.5 * norm(cross(mesh.points[c] - mesh.points[a], mesh.points[d] - mesh.points[b]));
  }
  for (const auto& [tag, area] : areas) EXPECT_NEAR(area, 1, 1e-9) << tag;
}

TEST(Layers, DividedIntoTetsFitEachOther) {
  const std::vector<PolygonSoup> soups{polygonal_box({0, 0, 0}, {1, 1, 1})};
  for (const char* wall : {"all:first=0.02,count=2", "1:first=0.02,count=2"}) {
    PipelineOptions options = with_layers({wall});
    options.layers.tets = true;
    const PipelineResult run = made(soups, options);
    const TetMesh& mesh = run.result.mesh;
    EXPECT_TRUE(mesh.layers.prisms.empty() && mesh.layers.pyramids.empty() && mesh.layers.quads.empty());
    EXPECT_GT(run.layers->tets, 0U);
    EXPECT_GT(least_jacobian_of(mesh), 0);
    EXPECT_NEAR(volume_of(mesh), 1, 1e-9);
  }
}

TEST(Layers, LeadToTheWallsBelowThem) {
  for (const bool tets : {false, true})
    for (const auto& [soup, walls] : {std::pair{wedge(20), "all"},
                                      {wedge(20), "5:first=0.02,count=2"},
                                      {polygonal_box({0, 0, 0}, {1, 1, 1}), "all:first=0.02,count=1"}}) {
      PipelineOptions options = with_layers({walls});
      options.layers.tets = tets;
      const PipelineResult run = made({soup}, options);
      const std::vector<Index>& known = run.layers->walls;
      const std::vector<Index> found = walls_below(run.result.mesh);
      ASSERT_GE(found.size(), known.size());
      for (Index v = 0; v < found.size(); ++v) {
        const Index wall = v < known.size() ? known[v] : none;
        EXPECT_EQ(found[v], wall == v ? none : wall) << walls << ", tets " << tets << ", point " << v;
      }
    }
}

/// Heights above a triangle of a curved wall vary, as its triangles deviate to both sides; their mean is that
/// asked for.
TEST(Layers, AreAsHighAboveCurvedWallsAsAsked) {
  constexpr double first = 0.02;
  for (const auto& soup : {polygonal_cylinder(40, 1, 2), sphere(6, 1, {0, 0, 0})}) {
    PipelineOptions options = with_layers({"all:first=0.02,count=1"});
    options.mesh.size = 0.3;
    const PipelineResult run = made({soup}, options);
    const auto& p = run.result.mesh.points;
    std::vector<double> errors;
    double sum = 0;
    for (const auto& prism : run.result.mesh.layers.prisms) {
      const Vector n = cross(p[prism[1]] - p[prism[0]], p[prism[2]] - p[prism[0]]);
      std::array<double, 3> heights{};
      for (unsigned k = 0; k < 3; ++k) heights[k] = dot(p[prism[k + 3]] - p[prism[k]], n) / norm(n) / first;
      if (*std::min_element(heights.begin(), heights.end()) < 0.9) continue;  // lowered
      const double error = (heights[0] + heights[1] + heights[2]) / 3 - 1;
      errors.push_back(std::fabs(error));
      sum += error;
    }
    ASSERT_GT(errors.size(), run.layers->prisms / 2);
    std::sort(errors.begin(), errors.end());
    EXPECT_LT(errors[errors.size() * 19 / 20], 0.02);
    EXPECT_LT(std::fabs(sum / static_cast<double>(errors.size())), 0.002);
  }
}

/// Where faces meet at less than 16 degrees, tets may have smaller angles than elsewhere. Tets in other
/// places must keep the usual bound.
TEST(Layers, KeepTheBoundsOfTheCoreBesideSharpEdges) {
  for (const double degrees : {4.0, 7.0, 10.0, 13.0})
    for (const double of_size : {0.1, 0.25}) {
      PipelineOptions options = with_layers({"all:first=0.01,count=3"});
      options.mesh.size = of_size;
      const SoupPipelineResult run = run_pipeline(std::vector<PolygonSoup>{wedge(degrees)}, options);
      EXPECT_TRUE(run.check.passed()) << degrees << ": " << run.missed();
      EXPECT_GT(run.layers->coverage(), 0.5) << degrees;
    }
}

TEST(Layers, StepDownIntoAWedge) {
  const PipelineResult run = made({wedge(20)}, with_layers({"all"}));
  EXPECT_GT(run.layers->coverage(), 0.8);
  EXPECT_LE(run.layers->largest_step, 2 + 1e-6);
  EXPECT_GT(least_jacobian_of(run.result.mesh), 0);
  EXPECT_NEAR(volume_of(run.result.mesh), 2 * std::sin(20 * M_PI / 180), 1e-9);
  EXPECT_FALSE(run.layers->reductions.empty());
}

TEST(Layers, OnBothSidesOfAnInterface) {
  const std::vector<PolygonSoup> soups{polygonal_box({0, 0, 0}, {1, 1, 1}),
                                       polygonal_box({1, 0, 0}, {2, 1, 1})};
  PipelineOptions options = with_layers({});
  const PipelineResult without = run_pipeline(soups, options);
  Tag interface = 0;
  for (std::size_t f = 0; f < without.result.mesh.faces.size(); ++f)
    if (const auto& [a, b] = without.result.mesh.face_regions[f]; a != 0 && b != 0)
      interface = without.result.mesh.face_tag[f];
  options.layers.walls = {std::to_string(interface) + ":first=0.02,count=2"};
  const PipelineResult run = made(soups, options);
  EXPECT_GT(least_jacobian_of(run.result.mesh), 0);
  EXPECT_NEAR(volume_of(run.result.mesh), 2, 1e-9);
  std::set<Index> regions(run.result.mesh.layers.prism_region.begin(),
                          run.result.mesh.layers.prism_region.end());
  EXPECT_EQ(regions.size(), 2U);
}

TEST(Layers, OnOneSideOfAnInterface) {
  const std::vector<PolygonSoup> soups{polygonal_box({0, 0, 0}, {1, 1, 1}),
                                       polygonal_box({1, 0, 0}, {2, 1, 1})};
  PipelineOptions options = with_layers({});
  const SoupPipelineResult without = run_pipeline(soups, options);
  Tag interface = 0;
  for (std::size_t f = 0; f < without.result.mesh.faces.size(); ++f)
    if (const auto& [a, b] = without.result.mesh.face_regions[f]; a != 0 && b != 0)
      interface = without.result.mesh.face_tag[f];
  const std::string text = std::to_string(interface) + ":first=0.02,count=2,region=";
  for (const Index region : {1U, 2U}) {
    const std::string only = text + std::to_string(without.plc.regions[region].tag);
    options.layers.walls = {only};
    const PipelineResult run = made(soups, options);
    EXPECT_NEAR(run.layers->coverage(), 1, 1e-9);
    EXPECT_GT(least_jacobian_of(run.result.mesh), 0);
    EXPECT_NEAR(volume_of(run.result.mesh), 2, 1e-9);
    ASSERT_FALSE(run.result.mesh.layers.prisms.empty());
    for (const Index of : run.result.mesh.layers.prism_region) EXPECT_EQ(of, region);
    // Layers on all other walls end where they meet the layers at the interface.
    options.layers.walls = {only, "all:first=0.02,count=2"};
    const PipelineResult both = made(soups, options);
    EXPECT_NEAR(volume_of(both.result.mesh), 2, 1e-9);
    EXPECT_GT(both.layers->coverage(), 0.8);
  }
}

TEST(Layers, AroundTwoRegionsMeetAtTheirInterface) {
  const std::vector<PolygonSoup> soups{polygonal_box({0, 0, 0}, {1, 1, 1}),
                                       polygonal_box({1, 0, 0}, {2, 1, 1})};
  const PipelineResult run = made(soups, with_layers({"all:first=0.02,count=2"}));
  EXPECT_NEAR(run.layers->coverage(), 1, 1e-9);
  EXPECT_NEAR(volume_of(run.result.mesh), 2, 1e-9);
  std::size_t between = 0;
  for (const auto& [a, b] : run.result.mesh.layers.quad_regions) between += a != 0 && b != 0;
  EXPECT_GT(between, 0U);
}

TEST(Layers, SlideAlongInterfacesThatArePlanarWithinTolerance) {
  std::vector<PolygonSoup> soups{polygonal_box({0, 0, 0}, {1, 1, 1}), polygonal_box({1, 0, 0}, {2, 1, 1})};
  constexpr double off = 1e-6;
  for (PolygonSoup& soup : soups)
    for (Point& p : soup.points)
      if (p.x == 1 && p.y == 0 && p.z == 0) p.x += off;
  const PipelineResult run = made(soups, with_layers({"all:first=0.02,count=2"}));
  EXPECT_NEAR(run.layers->coverage(), 1, 1e-9);
  EXPECT_NEAR(volume_of(run.result.mesh), 2, off);
}

TEST(Layers, OfSecondOrderFollowCurvedWalls) {
  const std::vector<PolygonSoup> soups{sphere(6, 1, {0, 0, 0})};
  PipelineOptions options = with_layers({"all"});
  options.order = 2;
  const PipelineResult run = made(soups, options);
  EXPECT_GT(run.layers->coverage(), 0.95);
  options.layers.walls.clear();
  const SoupPipelineResult without = run_pipeline(soups, options);
  TetMesh mesh = without.result.mesh;
  make_layers(mesh, without.plc, {.walls = {"all"}}, improve_options(2));
  ASSERT_GT(mesh.layers.prisms.size(), 0U);
  ASSERT_EQ(mesh.layers.prism_mid_nodes.size(), mesh.layers.prisms.size());
  const auto nodes_of = [](const TetMesh& of) {
    std::vector<Point> nodes;
    for (const auto& mid : of.face_mid_nodes)
      for (const Index node : mid) nodes.push_back(of.points[node]);
    std::sort(nodes.begin(), nodes.end(), [](const Point& a, const Point& b) {
      return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z < b.z;
    });
    return nodes;
  };
  const auto with = nodes_of(mesh), before = nodes_of(without.result.mesh);
  ASSERT_EQ(with.size(), before.size());
  for (std::size_t i = 0; i < with.size(); ++i) EXPECT_LT(distance(with[i], before[i]), 1e-12);
}

TEST(Layers, OfSecondOrderKeepTheVolumesOfCurvedParts) {
  // Layers are so thick that the core loses vertices, whose numbers go to other points.
  const std::vector<PolygonSoup> soups{sphere(6, 1, {0, 0, 0})};
  PipelineOptions options = with_layers({"all:first=0.15,count=2"});
  options.order = 2;
  const SoupPipelineResult run = run_pipeline(soups, options);
  const CheckReport report = check(run.result.mesh, run.plc, {});
  EXPECT_TRUE(report.passed()) << (report.findings.empty() ? "" : report.findings.front().message);
}

TEST(Layers, OfSecondOrderStayValidWhereTheyEndAtCurvedWalls) {
  // Triangles bulge more than the layers are high, so heights are 0 at nodes where the core meets the wall.
  const std::vector<PolygonSoup> soups{sphere(3, 1, {0, 0, 0})};
  for (const char* walls : {"all:count=1", "all:count=1,first=0.01"}) {
    PipelineOptions options = with_layers({walls});
    options.order = 2;
    options.mesh.size = 0.6;
    const SoupPipelineResult run = run_pipeline(soups, options);
    CheckReport report;
    checks::check_layer_cells(run.result.mesh, report);
    EXPECT_TRUE(report.passed()) << (report.findings.empty() ? "" : report.findings.front().message);
  }
}

TEST(Layers, OfSecondOrderKeepTheNodesOfCoarseCurvedWalls) {
  // Triangles bulge about as much as layers are high.
  for (const char* walls :
       {"all:count=1", "all:count=3", "all:count=1,first=0.05", "all:count=2,first=0.1"}) {
    PipelineOptions options = with_layers({});
    options.order = 2;
    options.mesh.size = 0.6;
    const SoupPipelineResult without =
        run_pipeline(std::vector<PolygonSoup>{sphere(3, 1, {0, 0, 0})}, options);
    TetMesh mesh = without.result.mesh;
    make_layers(mesh, without.plc, {.walls = {walls}}, improve_options(2));
    const auto nodes_of = [](const TetMesh& mesh) {
      std::vector<std::array<Point, 3>> nodes;
      for (std::size_t f = 0; f < mesh.faces.size(); ++f)
        for (unsigned k = 0; k < 3; ++k) {
          std::array<Point, 3> at{mesh.points[mesh.faces[f][k]], mesh.points[mesh.faces[f][(k + 1) % 3]],
                                  mesh.points[mesh.face_mid_nodes[f][k]]};
          nodes.push_back(at);
        }
      return nodes;
    };
    const auto before = nodes_of(without.result.mesh), with = nodes_of(mesh);
    ASSERT_EQ(before.size(), with.size());
    std::size_t moved = 0;
    for (const auto& [a, b, node] : with) {
      const Point &from = a, &to = b;
      const auto same = std::find_if(before.begin(), before.end(), [&](const std::array<Point, 3>& other) {
        return (other[0] == from && other[1] == to) || (other[0] == to && other[1] == from);
      });
      ASSERT_NE(same, before.end());
      if (distance((*same)[2], node) > 1e-12) ++moved;
    }
    EXPECT_EQ(moved, 0U) << walls;
    // The report is that of the mesh with layers.
    options.layers.walls = {walls};
    const SoupPipelineResult run = run_pipeline(std::vector<PolygonSoup>{sphere(3, 1, {0, 0, 0})}, options);
    EXPECT_TRUE(run.check.passed()) << walls << ": " << run.missed();
    std::size_t first = run.result.mesh.points.size();
    for (const auto& mid : run.result.mesh.tet_mid_nodes)
      for (const Index node : mid) first = std::min<std::size_t>(first, node);
    EXPECT_EQ(run.second_order.nodes, run.result.mesh.points.size() - first);
    for (const auto& straight : run.second_order.straightened)
      EXPECT_LT(distance(straight.where, run.result.mesh.points[straight.point]), 1e-12);
  }
}

TEST(Layers, OfSecondOrderKnowTheFacesOfTheirNodes) {
  const std::vector<PolygonSoup> soups{polygonal_box({0, 0, 0}, {1, 1, 1}),
                                       polygonal_box({1, 0, 0}, {2, 1, 1})};
  for (const char* walls : {"all:count=1", "1:count=1", "1:count=3"}) {
    PipelineOptions options = with_layers({walls});
    options.order = 2;
    const SoupPipelineResult run = run_pipeline(soups, options);
    ASSERT_FALSE(run.result.mesh.layers.quads.empty());
    const CheckReport report = check(run.result.mesh, run.plc, {});
    EXPECT_TRUE(report.passed()) << (report.findings.empty() ? "" : report.findings.front().message);
  }
}

std::string error_of(const std::vector<std::string>& walls,
                     const std::vector<PolygonSoup>& soups = {polygonal_box({0, 0, 0}, {1, 1, 1})}) {
  try {
    run_pipeline(soups, with_layers(walls));
  } catch (const OptionError& error) {
    return error.what();
  }
  return {};
}

TEST(Layers, RefuseWallsThatAreNone) {
  EXPECT_NE(error_of({"9"}).find("layers: no face is called '9'"), std::string::npos) << error_of({"9"});
  EXPECT_NE(error_of({"1", "1:count=2"}).find("face 1 gets layers twice"), std::string::npos);
  EXPECT_NE(error_of({"all:first=x"}).find("no number"), std::string::npos);
  EXPECT_NE(error_of({"all:count=0"}).find("count"), std::string::npos);
  EXPECT_NE(error_of({"all:height=1"}).find("thickness"), std::string::npos);
  EXPECT_NE(error_of({"1:region=9"}).find("no region is called '9'"), std::string::npos);
  const std::vector<PolygonSoup> two{polygonal_box({0, 0, 0}, {1, 1, 1}),
                                     polygonal_box({2, 0, 0}, {3, 1, 1})};
  EXPECT_NE(error_of({"1:region=2"}, two).find("is not beside region '2'"), std::string::npos);
  EXPECT_NE(error_of({"all:first=0.1,thickness=1"}).find("leave one out"), std::string::npos);
  EXPECT_NE(error_of({"all:count=3", "all:count=5"}).find("gets layers twice"), std::string::npos);
  EXPECT_NE(error_of({"all:region=1", "all:count=5"}, two).find("gets layers twice"), std::string::npos);
  EXPECT_NE(error_of({"1,2,3,4,5,6", "all:count=5"}).find("'all:count=5' covers no face"), std::string::npos);
}

TEST(Layers, RefuseFirstLayersThinnerThanCoordinatesTell) {
  for (const char* wall : {"all:growth=10,count=1000", "all:growth=10,count=20", "all:first=1e-30",
                           "all:thickness=1e-11", "all:thickness=0.1,growth=2,count=60"}) {
    const std::string error = error_of({wall});
    EXPECT_NE(error.find(wall), std::string::npos) << wall << ": " << error;
    for (const char* setting : {"first height", "growth", "count"})
      EXPECT_NE(error.find(setting), std::string::npos) << error;
  }
  made({polygonal_box({0, 0, 0}, {1, 1, 1})}, with_layers({"all:first=1e-8"}));
}

TEST(Layers, ThickerThanThePartAreLower) {
  const std::vector<PolygonSoup> soups{polygonal_box({0, 0, 0}, {1, 1, 0.2})};
  const PipelineResult run = made(soups, with_layers({"all:thickness=0.5,count=3"}));
  EXPECT_GT(least_jacobian_of(run.result.mesh), 0);
  EXPECT_NEAR(volume_of(run.result.mesh), 0.2, 1e-9);
  ASSERT_FALSE(run.layers->reductions.empty());
  EXPECT_GT(run.layers->coverage(), 0.8);
}

TEST(Layers, ThatCoverLittleAreWarnedOf) {
  PipelineOptions options = with_layers({"all"});
  const PipelineResult good = made({polygonal_box({0, 0, 0}, {1, 1, 1})}, options);
  EXPECT_TRUE(good.check.warnings.empty());
  options.mesh.size = 1;
  const PipelineResult poor = made({polygonal_box({0, 0, 0}, {5, 5, 0.1})}, options);
  ASSERT_LT(poor.layers->coverage(), 0.8);
  ASSERT_FALSE(poor.check.warnings.empty());
  const std::string& warning = poor.check.warnings.back();
  for (const char* part : {"layers cover only", "thickness", "count", "size"})
    EXPECT_NE(warning.find(part), std::string::npos) << warning;
}

TEST(Layers, AreInTheMeshThatIsJudged) {
  const PipelineResult run = made({polygonal_box({0, 0, 0}, {1, 1, 1}), polygonal_box({1, 0, 0}, {2, 1, 1})},
                                  with_layers({"1:first=0.02,count=2"}));
  const CheckReport& report = run.check;
  EXPECT_EQ(report.tets, run.result.mesh.tets.size());
  EXPECT_EQ(report.faces, run.result.mesh.faces.size());
  ASSERT_EQ(report.region_volumes.size(), 3U);
  for (const Index region : {1U, 2U}) EXPECT_NEAR(report.region_volumes[region], 1, 1e-9);
  ASSERT_EQ(report.of_mesh.areas.size(), report.of_input.areas.size());
  for (std::size_t p = 0; p < report.of_mesh.areas.size(); ++p)
    EXPECT_NEAR(report.of_mesh.areas[p], report.of_input.areas[p], 1e-9);
}

TEST(Layers, MuchThickerThanThePartAreLowerToo) {
  const PipelineResult run = made({polygonal_box({0, 0, 0}, {1, 1, 1})}, with_layers({"all:thickness=100"}));
  EXPECT_NEAR(volume_of(run.result.mesh), 1, 1e-9);
  EXPECT_GT(run.layers->coverage(), 0.8);
}

TEST(Layers, OfNeighboursDifferInHeightByAFactorOfTwo) {
  for (const double degrees : {12.0, 20.0, 45.0}) {
    const PipelineResult run = made({wedge(degrees)}, with_layers({"all"}));
    const TetMesh& mesh = run.result.mesh;
    std::vector<Vector> way(mesh.points.size());  // by vertex of the wall: to the top of its layers
    for (Index v = 0; v < run.layers->walls.size(); ++v)
      if (const Index wall = run.layers->walls[v]; wall != none && wall != v)
        if (const Vector up = mesh.points[v] - mesh.points[wall]; norm(up) > norm(way[wall])) way[wall] = up;
    std::vector<double> height(mesh.points.size(), INFINITY);
    for (const auto& face : mesh.faces) {
      const auto& [a, b, c] = face;
      const Vector normal = cross(mesh.points[b] - mesh.points[a], mesh.points[c] - mesh.points[a]);
      for (const Index v : face)
        height[v] = std::min(height[v], std::fabs(dot(way[v], normal)) / norm(normal));
    }
    double largest = 1;
    for (const auto& face : mesh.faces)
      for (const Index v : face)
        for (const Index w : face)
          if (height[v] > 0 && height[w] > 0) largest = std::max(largest, height[v] / height[w]);
    EXPECT_LE(largest, 2 + 1e-6) << degrees;
    EXPECT_NEAR(largest, run.layers->largest_step, 1e-6) << degrees;
  }
}

}  // namespace
}  // namespace collarmesh::layers_test
