// Sizes and ratios that are asked for: each bound recomputed from meshes of `generate`.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <queue>

#include "collarmesh/error.h"
#include "collarmesh/pipeline.h"
#include "collarmesh/predict.h"
#include "support/meshing.h"
#include "support/shapes.h"

namespace collarmesh::refinement_sizing_test {
namespace {

using testing::faults;
using testing::mesh_of;
using testing::Meshed;
using testing::with_size;

// The target edge length is this multiple of the size; cells, triangles and edges are split above multiples
// of it (doc/architecture/refinement.md).
constexpr double edge_per_size = 1.08;
constexpr double cell_radius_per_size = 0.79 * edge_per_size;
constexpr double triangle_radius_per_size = 0.7 * edge_per_size;
constexpr double edge_length_per_size = 1.3 * edge_per_size;
constexpr double rounding = 1 + 1e-9;

Point centroid(const TetMesh& mesh, const std::array<Index, 4>& t) {
  return 0.25 * ((mesh.points[t[0]] + mesh.points[t[1]]) + (mesh.points[t[2]] + mesh.points[t[3]]));
}

double largest_radius_in_region(const TetMesh& mesh, Index region) {
  const auto radii = testing::circumradii(mesh);
  double largest = 0;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    if (mesh.tet_region[t] == region) largest = std::max(largest, radii[t]);
  return largest;
}

double largest_radius_with_tag(const TetMesh& mesh, Tag tag) {
  double largest = 0;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const auto& [a, b, c] = mesh.faces[f];
    if (mesh.face_tag[f] == tag)
      largest = std::max(largest, testing::circumradius(mesh.points[a], mesh.points[b], mesh.points[c]));
  }
  return largest;
}

TEST(RefinementSizing, MedianEdgeIsNearTheTarget) {
  const auto expect_near_target = [](const PolygonSoup& soup, double size) {
    const Meshed meshed = mesh_of(soup, with_size(size));
    EXPECT_EQ(faults(meshed), "");
    EXPECT_NEAR(meshed.report.median_edge, size, 0.2 * size);
  };
  for (const double size : {0.15, 0.05}) expect_near_target(testing::box(), size);
  // With sizes at which triangles are near enough to the sphere without further refinement.
  for (const double size : {0.12, 0.08}) expect_near_target(testing::icosphere(1, 16), size);
}

TEST(RefinementSizing, GlobalSizeBoundsCellsFacesAndEdges) {
  const Meshed meshed = mesh_of(testing::box(), with_size(0.1));
  EXPECT_EQ(faults(meshed), "");
  const TetMesh& mesh = meshed.result.mesh;
  EXPECT_LE(largest_radius_in_region(mesh, 1), cell_radius_per_size * 0.1 * rounding);
  for (Tag side = 1; side <= 6; ++side)
    EXPECT_LE(largest_radius_with_tag(mesh, side), triangle_radius_per_size * 0.1 * rounding);
  for (const auto& [a, b] : mesh.edges)
    EXPECT_LE(distance(mesh.points[a], mesh.points[b]), edge_length_per_size * 0.1 * rounding);
}

TEST(RefinementSizing, DefaultIsATwentiethOfTheDiagonal) {
  const Meshed meshed = mesh_of(testing::box({0, 0, 0}, {3, 2, 1}));
  EXPECT_EQ(faults(meshed), "");
  const double size = meshed.plc.bounds.diagonal() / 20;
  EXPECT_NEAR(meshed.report.median_edge, size, 0.2 * size);
}

TEST(RefinementSizing, RegionsHaveTheirOwn) {
  MeshOptions options = with_size(0.4);
  options.region_size[20] = 0.1;
  const Meshed meshed = mesh_of(testing::two_boxes(), options, 0);
  EXPECT_EQ(faults(meshed), "");
  const TetMesh& mesh = meshed.result.mesh;
  for (Index r = 1; r <= 2; ++r)
    EXPECT_LE(largest_radius_in_region(mesh, r),
              cell_radius_per_size * (meshed.plc.regions[r].tag == 20 ? 0.1 : 0.4) * rounding);
  const auto fine = std::count(mesh.tet_tag.begin(), mesh.tet_tag.end(), 20);
  EXPECT_GT(fine, 4 * std::count(mesh.tet_tag.begin(), mesh.tet_tag.end(), 10));
}

TEST(RefinementSizing, RegionPointsGiveOne) {
  PolygonSoup soup = testing::two_boxes();
  soup.region_points[0].size = 0.12;
  const Meshed meshed = mesh_of(soup, with_size(0.5), 0);
  EXPECT_EQ(faults(meshed), "");
  for (Index r = 1; r <= 2; ++r)
    EXPECT_LE(largest_radius_in_region(meshed.result.mesh, r),
              cell_radius_per_size * (meshed.plc.regions[r].tag == 10 ? 0.12 : 0.5) * rounding);
}

TEST(RefinementSizing, PatchesHaveTheirOwn) {
  MeshOptions options = with_size(0.4);
  options.patch_size[6] = 0.06;
  const Meshed meshed = mesh_of(testing::box(), options, 0);
  EXPECT_EQ(faults(meshed), "");
  EXPECT_LE(largest_radius_with_tag(meshed.result.mesh, 6), triangle_radius_per_size * 0.06 * rounding);
  EXPECT_GT(largest_radius_with_tag(meshed.result.mesh, 5), 2 * triangle_radius_per_size * 0.06);
}

TEST(RefinementSizing, CurvesHaveTheirOwn) {
  PolygonSoup soup = testing::box();
  soup.points.insert(soup.points.end(), {{0.3, 0.3, 0.4}, {0.7, 0.4, 0.6}});
  soup.segments.push_back({8, 9, 5});
  MeshOptions options = with_size(0.4);
  options.curve_size[5] = 0.02;
  const Meshed meshed = mesh_of(soup, options, 0);
  EXPECT_EQ(faults(meshed), "");
  const TetMesh& mesh = meshed.result.mesh;
  std::size_t fine = 0;
  for (std::size_t e = 0; e < mesh.edges.size(); ++e) {
    if (mesh.edge_tag[e] != 5) continue;
    ++fine;
    EXPECT_LE(distance(mesh.points[mesh.edges[e][0]], mesh.points[mesh.edges[e][1]]),
              edge_length_per_size * 0.02 * rounding);
  }
  EXPECT_GE(fine, 18U);
}

// If curves are meshed before the cells around them have good quality, they become hubs: conflict zones, time
// and memory grow with the square of the result.
TEST(RefinementSizing, FineCurvesTakeHardlyMoreMemoryPerCellThanFineRegions) {
  const Plc plc = build_plc(std::array{testing::box()}, {});
  const auto bytes_per_cell = [&](double size, double along_curves) {
    MeshOptions options = with_size(size);
    for (const Plc::Curve& curve : plc.curves) options.curve_size[curve.tag] = along_curves;
    const MeshResult result = generate(plc, options);
    EXPECT_EQ(result.status, MeshStatus::complete);
    EXPECT_GT(result.statistics.cells, 100000U);
    return static_cast<double>(result.statistics.peak_bytes) / static_cast<double>(result.statistics.cells);
  };
  EXPECT_LE(bytes_per_cell(1, 1.0 / 1024), 1.3 * bytes_per_cell(0.04, 0.04));
}

TEST(RefinementSizing, FieldBoundsCellsAtTheirCentres) {
  const auto field = [](const Point& p) { return 0.04 + 0.3 * distance(p, {0.2, 0.3, 0.4}); };
  MeshOptions options = with_size(1);
  options.size_field = field;
  const Meshed meshed = mesh_of(testing::box(), options, 0);
  EXPECT_EQ(faults(meshed), "");
  const TetMesh& mesh = meshed.result.mesh;
  const auto radii = testing::circumradii(mesh);
  // The field is evaluated at the circumcentre, which lies within the radius of the centroid.
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    EXPECT_LE(radii[t],
              cell_radius_per_size * (field(centroid(mesh, mesh.tets[t])) + 0.3 * radii[t]) * rounding);
  MeshOptions fine = options;
  fine.size_field = [](const Point&) { return 0.04; };
  fine.size_min = 0.2;
  EXPECT_LT(mesh_of(testing::box(), fine, 0).result.mesh.tets.size(), mesh.tets.size());
}

// Every stage that asks for sizes refuses wrong ones.
TEST(RefinementSizing, FieldsMustBePositive) {
  const PolygonSoup soups[] = {testing::box()};
  const Plc plc = build_plc(soups);
  for (const double wrong : {0.0, -1.0, double{NAN}, -double{INFINITY}}) {
    MeshOptions options;
    options.size_field = [&](const Point& p) { return p.x > 0.9 ? wrong : INFINITY; };
    PipelineOptions whole;
    whole.mesh = options;
    const std::vector<std::function<void()>> stages{[&] { generate(plc, options); },
                                                    [&] { run_pipeline(plc, whole); },
                                                    [&] { predict(plc, whole, std::array{0.1}); }};
    for (const auto& stage : stages) try {
        stage();
        ADD_FAILURE() << wrong << " was taken";
      } catch (const OptionError& error) {
        const std::string said = error.what();
        EXPECT_NE(said.find(fmt::format("the size is {} at (", wrong)), std::string::npos) << said;
        const double x = std::stod(said.substr(said.find('(') + 1));
        EXPECT_GT(x, 0.9) << said;
      }
  }
}

TEST(RefinementSizing, FieldSeesTheInputsCoordinates) {
  const Vector shift{1e3, -2e3, 5e3};
  MeshOptions options = with_size(0.5);
  Box seen;
  options.size_field = [&](const Point& p) {
    seen.add(p);
    return 0.2;
  };
  EXPECT_EQ(faults(mesh_of(testing::translated(testing::box(), shift), options, 0)), "");
  ASSERT_FALSE(seen.empty());
  EXPECT_LT(distance(seen.centre(), shift + Vector{0.5, 0.5, 0.5}), 1.5);
}

// Returns the length of the shortest path along mesh edges from the vertices of faces with this tag.
std::vector<double> way_from_tag(const TetMesh& mesh, Tag tag) {
  std::vector<std::vector<Index>> adjacent(mesh.points.size());
  for (const auto& t : mesh.tets)
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = 0; j < 4; ++j)
        if (i != j) adjacent[t[i]].push_back(t[j]);
  std::vector<double> way(mesh.points.size(), INFINITY);
  using Entry = std::pair<double, Index>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> front;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f)
    for (const Index v : mesh.faces[f])
      if (mesh.face_tag[f] == tag) front.push({way[v] = 0, v});
  while (!front.empty()) {
    const auto [length, v] = front.top();
    front.pop();
    if (length > way[v]) continue;
    for (const Index u : adjacent[v]) {
      const double longer = length + distance(mesh.points[v], mesh.points[u]);
      if (longer >= way[u]) continue;
      front.push({way[u] = longer, u});
    }
  }
  return way;
}

// Away from a fine side the target grows by the gradation along every edge, so a tet's radius is bounded by
// the target at any corner plus the growth over its own radius.
TEST(RefinementSizing, GradationLimitsGrowthAwayFromAFineSide) {
  std::size_t tets_before = 0;
  for (const double gradation : {0.6, 0.2, 0.1}) {
    SCOPED_TRACE(gradation);
    MeshOptions options = with_size(0.5);
    options.patch_size[6] = 0.05;
    options.gradation = gradation;
    const Meshed meshed = mesh_of(testing::box(), options, 0);
    EXPECT_EQ(faults(meshed), "");
    const TetMesh& mesh = meshed.result.mesh;
    const auto way = way_from_tag(mesh, 6);
    const auto radii = testing::circumradii(mesh);
    std::size_t violations = 0;
    for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
      double nearest = INFINITY;
      for (const Index v : mesh.tets[t]) nearest = std::min(nearest, way[v]);
      const double target =
          std::min(edge_per_size * 0.5, edge_per_size * 0.05 + gradation * (nearest + radii[t]));
      if (radii[t] > cell_radius_per_size / edge_per_size * target * (1 + 1e-5)) ++violations;
    }
    EXPECT_EQ(violations, 0U);
    EXPECT_GT(mesh.tets.size(), tets_before);
    tets_before = mesh.tets.size();
  }
}

// Returns the largest ratio of a circumradius to the shortest edge at one vertex.
double largest_vertex_ratio(const TetMesh& mesh) {
  std::vector<double> shortest(mesh.points.size(), INFINITY), largest(mesh.points.size(), 0);
  const auto radii = testing::circumradii(mesh);
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    for (const Index v : mesh.tets[t]) {
      largest[v] = std::max(largest[v], radii[t]);
      for (const Index u : mesh.tets[t])
        if (u != v) shortest[v] = std::min(shortest[v], distance(mesh.points[u], mesh.points[v]));
    }
  double ratio = 0;
  for (std::size_t v = 0; v < mesh.points.size(); ++v) ratio = std::max(ratio, largest[v] / shortest[v]);
  return ratio;
}

TEST(RefinementQuality, VertexRatioIsKept) {
  for (const PolygonSoup& soup : {testing::box_with_cavity(0.05), testing::two_boxes()})
    for (const double bound : {2.9, 4.0}) {
      SCOPED_TRACE(bound);
      MeshOptions options = with_size(0.4);
      options.vertex_ratio = bound;
      const Meshed meshed = mesh_of(soup, options, 0);
      EXPECT_EQ(faults(meshed), "");
      EXPECT_LE(largest_vertex_ratio(meshed.result.mesh), bound * rounding);
    }
}

TEST(RefinementQuality, TighterRadiusEdge) {
  for (const PolygonSoup& soup :
       {testing::box(), testing::icosphere(1, 8), testing::plate_with_hole(1, 16)}) {
    MeshOptions options = with_size(0.4);
    options.bounds.radius_edge = 1.5;
    const Meshed meshed = mesh_of(soup, options);
    EXPECT_EQ(faults(meshed), "");
    EXPECT_LE(meshed.report.max_radius_edge, 1.5 * rounding);
  }
}

TEST(RefinementQuality, TighterDistance) {
  MeshOptions options = with_size(0.5);
  options.bounds.distance = 1e-3;
  const Meshed meshed = mesh_of(testing::icosphere(1, 30), options);
  EXPECT_EQ(faults(meshed), "");
  EXPECT_LE(meshed.report.max_surface_distance, 1e-3 * rounding);
}

}  // namespace
}  // namespace collarmesh::refinement_sizing_test
