// Small and thin regions keep their volume with default options, and the certificate measures how well.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "collarmesh/pipeline.h"
#include "collarmesh/plc_builder.h"
#include "support/expected_counts.h"
#include "support/meshing.h"
#include "support/shapes.h"

namespace collarmesh::shape_kept_test {
namespace {

using testing::with_size;

double enclosed_by(const PolygonSoup& soup) {
  double volume = 0;
  for (Index p = 0; p < soup.polygon_count(); ++p) {
    const auto corners = soup.polygon(p);
    for (std::size_t i = 1; i + 1 < corners.size(); ++i)
      volume += dot(soup.points[corners[0]] - Point{},
                    cross(soup.points[corners[i]] - Point{}, soup.points[corners[i + 1]] - Point{})) /
                6;
  }
  return std::fabs(volume);
}

/// Returns the solid between two closed surfaces.
PolygonSoup hollow(const PolygonSoup& outer, const PolygonSoup& inner) {
  PolygonSoup both = outer;
  const auto first = static_cast<Index>(both.points.size());
  both.points.insert(both.points.end(), inner.points.begin(), inner.points.end());
  for (Index p = 0; p < inner.polygon_count(); ++p) {
    std::vector<Index> corners;
    for (const Index corner : inner.polygon(p)) corners.insert(corners.begin(), first + corner);
    both.add_facet(corners);
  }
  return both;
}

/// Nested surfaces, the outermost first.
struct Nested {
  std::string name;
  std::vector<PolygonSoup> soups;
  double size;
};

std::vector<Nested> nested_shapes() {
  using namespace testing;
  return {{"rod", {cylinder(0.03, 1, 48)}, 0.5},
          {"ball in a box", {box({-1, -1, -1}, {1, 1, 1}), icosphere(0.05, 8)}, 0.4},
          {"thick shell", {icosphere(1, 10), icosphere(0.7, 10)}, 0.5},
          {"thin shell", {icosphere(1, 16), icosphere(0.93, 16)}, 0.4}};
}

class ShapeKept : public ::testing::TestWithParam<unsigned> {};

TEST_P(ShapeKept, EveryRegionHasItsVolume) {
  for (const Nested& shape : nested_shapes()) {
    SCOPED_TRACE(shape.name);
    PipelineOptions options;
    options.mesh = with_size(shape.size);
    options.order = GetParam();
    const SoupPipelineResult made = run_pipeline(shape.soups, options);
    EXPECT_EQ(made.missed(), "");
    std::vector<double> expected{0};
    for (std::size_t i = 0; i < shape.soups.size(); ++i)
      expected.push_back(enclosed_by(shape.soups[i]) -
                         (i + 1 < shape.soups.size() ? enclosed_by(shape.soups[i + 1]) : 0));
    const ShapeMeasures &input = made.check.of_input, &mesh = made.check.of_mesh;
    ASSERT_EQ(mesh.volumes.size(), expected.size());
    std::vector<double> volumes = mesh.volumes, given = input.volumes;
    std::sort(expected.begin(), expected.end());
    std::sort(volumes.begin(), volumes.end());
    std::sort(given.begin(), given.end());
    for (std::size_t r = 1; r < expected.size(); ++r) {
      EXPECT_NEAR(given[r], expected[r], 1e-9 * expected[r]);
      EXPECT_NEAR(volumes[r], expected[r], (GetParam() == 1 ? 0.05 : 0.01) * expected[r]);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Order, ShapeKept, ::testing::Values(1U, 2U));

/// Meshes a shell given by few facets, far thinner than the size, from constrained tetrahedra.
SoupPipelineResult meshed_shell(unsigned segments, double thickness, unsigned order) {
  const auto ball = [&](double radius) { return testing::uv_sphere(radius, segments / 2, segments); };
  const double radius = 5.7735;
  const PolygonSoup shell = hollow(ball(radius), ball(radius - thickness));
  PipelineOptions options;
  options.mesh = with_size(1);
  options.order = order;
  options.start = Start::constrained;
  SoupPipelineResult made = run_pipeline({&shell, 1}, options);
  const double expected = enclosed_by(ball(radius)) - enclosed_by(ball(radius - thickness));
  EXPECT_NEAR(made.check.of_mesh.volumes.at(1), expected, (order == 1 ? 0.05 : 0.01) * expected);
  return made;
}

TEST(ShapeKept, AShellFarThinnerThanTheSizeKeepsItsVolume) {
  for (const unsigned order : {1U, 2U}) {
    SCOPED_TRACE(order);
    const SoupPipelineResult made = meshed_shell(32, 0.002, order);
    EXPECT_EQ(made.missed(), "");
    testing::expect_count(fmt::format("shape kept/thin shell/order {}", order), made.result.mesh.tets.size());
  }
}

// Facets longer than the size are divided. Tets of thin walls are long only if vertices on both sides face
// each other.
TEST(ShapeKept, VerticesOfACoarseThinShellFaceEachOther) {
  const SoupPipelineResult made = meshed_shell(16, 0.02, 1);
  EXPECT_LT(100 * made.check.findings_total, made.result.mesh.tets.size());
}

// Refinement would make elements as short along the tube as around it.
TEST(ShapeKept, TubesFarThinnerThanTheSizeKeepTheirVolume) {
  for (const auto& [radius, segments] : {std::pair(0.005, 24U), {0.1, 96U}})
    for (const unsigned order : {1U, 2U}) {
      SCOPED_TRACE(std::to_string(radius) + ", order " + std::to_string(order));
      constexpr double length = 20;
      const std::vector<Point> profile{
          {0.9 * radius, 0, 0}, {radius, 0, 0}, {radius, 0, length}, {0.9 * radius, 0, length}};
      const PolygonSoup tube = testing::revolution(profile, segments, true);
      PipelineOptions options;
      options.mesh = with_size(1);
      options.order = order;
      const SoupPipelineResult made = run_pipeline({&tube, 1}, options);
      EXPECT_EQ(made.missed(), "");
      const double expected = enclosed_by(tube);
      EXPECT_NEAR(made.check.of_mesh.volumes.at(1), expected, (order == 1 ? 0.02 : 0.01) * expected);
      testing::expect_count(fmt::format("shape kept/tube/radius {}/order {}", radius, order),
                            made.result.mesh.tets.size());
    }
}

// Ladders have as many points as the size asks for, whatever the limit.
TEST(ShapeKept, TubesHeedTheLimitOfVertices) {
  const std::vector<Point> profile{{0.018, 0, 0}, {0.02, 0, 0}, {0.02, 0, 20}, {0.018, 0, 20}};
  PipelineOptions options;
  options.mesh = with_size(1);
  options.start = Start::constrained;
  const std::vector tube{testing::revolution(profile, 24, true)};
  EXPECT_EQ(run_pipeline(tube, options).missed(), "");
  options.mesh.max_vertices = 300;
  EXPECT_EQ(run_pipeline(tube, options).result.status, MeshStatus::budget_hit);
}

/// Returns a curved wall of 80 degrees around the x axis, 12 long.
PolygonSoup roof(Index edges, double thickness) {
  constexpr double radius = 6, length = 12, half = 40 * std::numbers::pi / 180;
  PolygonSoup soup;
  for (Index i = 0; i <= edges; ++i)
    for (const double r : {radius - thickness, radius})
      for (const double x : {0., length}) {
        const double angle = half * (2. * i / edges - 1);
        soup.points.push_back({x, r * std::sin(angle), r * std::cos(angle)});
      }
  const auto at = [](Index i, Index outer, Index end) { return 4 * i + 2 * outer + end; };
  const auto add = [&](const std::array<Index, 4>& corners) { soup.add_facet(corners); };
  for (Index i = 0; i < edges; ++i) {
    add({at(i, 1, 0), at(i, 1, 1), at(i + 1, 1, 1), at(i + 1, 1, 0)});
    add({at(i, 0, 0), at(i + 1, 0, 0), at(i + 1, 0, 1), at(i, 0, 1)});
    add({at(i, 0, 0), at(i, 1, 0), at(i + 1, 1, 0), at(i + 1, 0, 0)});
    add({at(i, 0, 1), at(i + 1, 0, 1), at(i + 1, 1, 1), at(i, 1, 1)});
  }
  add({at(0, 0, 0), at(0, 0, 1), at(0, 1, 1), at(0, 1, 0)});
  add({at(edges, 0, 0), at(edges, 1, 0), at(edges, 1, 1), at(edges, 0, 1)});
  return soup;
}

// Rounding makes flat tets between the rungs for some directions of the diagonals.
TEST(ShapeKept, ThinWallsFindDiagonalsThatLeaveNoFlatTets) {
  for (const Index edges : {88, 104}) {
    PipelineOptions options;
    options.mesh = with_size(0.72);
    const SoupPipelineResult made = run_pipeline(std::vector{roof(edges, 0.002)}, options);
    EXPECT_EQ(made.missed(), "") << edges;
    EXPECT_LT(made.result.mesh.tets.size(), 11'000U) << edges;
  }
}

// A sphere bends in two directions, so its chords remove twice as much as those of a cylinder.
TEST(ShapeKept, ALargeBallLosesNoMoreThanARod) {
  PipelineOptions options;
  options.mesh = with_size(0.28);
  const SoupPipelineResult made = run_pipeline(std::vector{testing::icosphere(1, 24)}, options);
  EXPECT_EQ(made.missed(), "");
  EXPECT_NEAR(made.check.of_mesh.volumes.at(1), made.check.of_input.volumes.at(1),
              0.02 * made.check.of_input.volumes.at(1));
}

// A prism in place of a rod is a finding, unless the options ask for a distance that allows it.
TEST(ShapeKept, AVolumeThatIsLostIsAFinding) {
  const PolygonSoup rod = testing::cylinder(0.1, 1, 64);
  PipelineOptions options;
  options.mesh = with_size(0.5);
  options.mesh.bounds.distance = 0.04;
  const SoupPipelineResult made = run_pipeline({&rod, 1}, options);
  ASSERT_EQ(made.missed(), "");
  const double lost = 1 - made.check.of_mesh.volumes[1] / enclosed_by(rod);
  ASSERT_GT(lost, 0.06);
  EXPECT_EQ(made.check.warnings.size(), 1U);
  CheckOptions judge;
  judge.bounds.tolerance = SurfaceTolerance(0.04);
  const CheckReport report = check(made.result.mesh, made.plc, judge);
  ASSERT_EQ(report.findings.size(), 1U);
  EXPECT_EQ(report.findings[0].guarantee, "volume_kept");
  EXPECT_TRUE(report.warnings.empty());
}

// With a coarsely cut ball, the curved elements of the first try lose more than they may.
TEST(ShapeKept, TheSecondTryHasASmallerDistance) {
  const std::vector<PolygonSoup> soups{testing::box({-1, -1, -1}, {1, 1, 1}), testing::icosphere(0.02, 2)};
  PipelineOptions options;
  options.mesh = with_size(0.4);
  options.order = 2;
  options.seeds = 1;
  const std::string missed = run_pipeline(soups, options).missed();
  EXPECT_NE(missed.find("volume"), std::string::npos) << missed;
  options.seeds = 2;
  EXPECT_EQ(run_pipeline(soups, options).missed(), "");
}

TEST(ShapeKept, AreasAndLengthsAreThoseOfFacesAndEdges) {
  const PolygonSoup box = testing::box({0, 0, 0}, {1, 2, 3});
  PipelineOptions options;
  options.mesh = with_size(0.7);
  for (const unsigned order : {1U, 2U}) {
    options.order = order;
    const SoupPipelineResult made = run_pipeline({&box, 1}, options);
    ASSERT_EQ(made.missed(), "");
    for (const auto& measures : {made.check.of_input, made.check.of_mesh}) {
      double area = 0, length = 0;
      for (const double a : measures.areas) area += a;
      for (const double l : measures.lengths) length += l;
      EXPECT_NEAR(measures.volumes[1], 6, 1e-12);
      EXPECT_NEAR(area, 22, 1e-11);
      EXPECT_NEAR(length, 24, 1e-11);
    }
  }
}

// Two bodies of one region, and a void: the volumes that closed surfaces enclose.
TEST(ShapeKept, EveryClosedSurfaceIsJudged) {
  const PolygonSoup soup = testing::joined(
      testing::joined(testing::box({-1, -1, -1}, {1, 1, 1}), testing::inverted(testing::icosphere(0.05, 8))),
      testing::translated(testing::icosphere(0.03, 8), {3, 0, 0}));
  const double void_volume = enclosed_by(testing::icosphere(0.05, 8)),
               ball = enclosed_by(testing::icosphere(0.03, 8));
  for (const unsigned order : {1U, 2U}) {
    PipelineOptions options;
    options.mesh = with_size(0.4);
    options.order = order;
    const SoupPipelineResult made = run_pipeline({&soup, 1}, options);
    ASSERT_EQ(made.missed(), "");
    const double most = order == 1 ? 0.05 : 0.01;
    std::vector<double> input = made.check.of_input.shells, mesh = made.check.of_mesh.shells;
    ASSERT_EQ(input.size(), shells_of(made.plc).size());
    std::sort(input.begin(), input.end());
    std::sort(mesh.begin(), mesh.end());
    ASSERT_GE(input.size(), 2U);
    EXPECT_NEAR(mesh.front(), input.front(), most * input.front());
    EXPECT_TRUE(
        std::any_of(input.begin(), input.end(), [&](double v) { return std::fabs(v - void_volume) < 1e-9; }));
    for (std::size_t i = 0; i < input.size(); ++i) EXPECT_NEAR(mesh[i], input[i], most * input[i]);
    EXPECT_NEAR(made.check.of_mesh.volumes[1] +
                    (made.check.of_mesh.volumes.size() > 2 ? made.check.of_mesh.volumes[2] : 0),
                8 - void_volume + ball, 0.05 * (void_volume + ball));
  }
}

TEST(ShapeKept, AVoidThatIsLostIsAFinding) {
  const PolygonSoup soup =
      testing::joined(testing::box({-1, -1, -1}, {1, 1, 1}), testing::inverted(testing::icosphere(0.05, 8)));
  PipelineOptions options;
  options.mesh = with_size(0.4);
  options.mesh.bounds.distance = 0.02;
  const SoupPipelineResult made = run_pipeline({&soup, 1}, options);
  ASSERT_EQ(made.missed(), "");
  ASSERT_FALSE(made.check.warnings.empty());
  CheckOptions judge;
  judge.bounds.tolerance = SurfaceTolerance(0.02);
  const CheckReport report = check(made.result.mesh, made.plc, judge);
  ASSERT_FALSE(report.findings.empty());
  EXPECT_EQ(report.findings[0].guarantee, "volume_kept");
  EXPECT_NE(report.findings[0].message.find("closed surface"), std::string::npos);
}

/// A block with a blade on one side, thickest in the middle: two arcs that meet in a sharp edge.
std::vector<Point> outline_of_a_blade(double length, double thickness) {
  constexpr unsigned steps = 32;
  const auto half_thickness = [&](double x) { return thickness / 2 * (0.2 + 4 * x) * (1 - x); };
  std::vector<Point> outline{{-10, -10, 0}, {0, -10, 0}};
  for (unsigned i = 0; i <= steps; ++i) {
    const double x = static_cast<double>(i) / steps;
    outline.push_back({x * length, -half_thickness(x), 0});
  }
  for (unsigned i = steps; i-- > 0;) {
    const double x = static_cast<double>(i) / steps;
    outline.push_back({x * length, half_thickness(x), 0});
  }
  outline.push_back({0, 10, 0});
  outline.push_back({-10, 10, 0});
  return outline;
}

PolygonSoup blade_on_a_block(double length, double thickness, double height) {
  const std::vector<Point> outline = outline_of_a_blade(length, thickness);
  const PolygonSoup faces = testing::extrusion(outline, height);
  PolygonSoup blade;
  blade.points = faces.points;
  const auto corners_on_arc = [&](std::span<const Index> corners, double sign) {
    return std::ranges::all_of(corners, [&](Index i) {
      const Point& p = faces.points[i];
      return p.x >= 0 && sign * p.y >= 0 && std::fabs(p.y) < thickness;
    });
  };
  for (Index p = 0; p < faces.polygon_count(); ++p) {
    const auto corners = faces.polygon(p);
    const Tag tag = corners_on_arc(corners, -1)  ? 1001
                    : corners_on_arc(corners, 1) ? 1002
                                                 : faces.facet_tag(p);
    blade.add_facet(corners, tag);
  }
  return blade;
}

// The region is so large that its volume says nothing about the blade.
TEST(ShapeKept, ABladeOnABlockKeepsItsThickness) {
  const double height = 2;
  const PolygonSoup soup = blade_on_a_block(1, 0.08, height);
  const double block = 200 * height, blade = enclosed_by(soup) - block;
  for (const unsigned order : {1U, 2U}) {
    PipelineOptions options;
    options.mesh = with_size(2);
    options.order = order;
    const SoupPipelineResult made = run_pipeline({&soup, 1}, options);
    ASSERT_EQ(made.missed(), "");
    EXPECT_NEAR(made.check.of_mesh.volumes[1] - block, blade, (order == 1 ? 0.05 : 0.01) * blade);
  }
}

TEST(ShapeKept, ABladeThatIsFlattenedIsAFinding) {
  const PolygonSoup soup = blade_on_a_block(1, 0.08, 2);
  PipelineOptions options;
  options.mesh = with_size(2);
  SoupPipelineResult made = run_pipeline({&soup, 1}, options);
  const auto finds = [&](double distance) {
    CheckOptions judge;
    judge.bounds.distance = distance;
    const CheckReport report = check(made.result.mesh, made.plc, judge);
    return std::ranges::any_of(report.findings,
                               [](const Finding& finding) { return finding.guarantee == "thickness_kept"; });
  };
  EXPECT_FALSE(finds(0));
  for (Point& p : made.result.mesh.points)
    if (p.x > 1e-9) p.y *= 0.3;
  EXPECT_TRUE(finds(0));
  EXPECT_FALSE(finds(0.1));
}

// A plane, and a surface 60 long that leaves it at 3 degrees and soon bends away: they are close to each
// other on only a hundredth of the surface.
PolygonSoup wedge_at_the_end_of_a_surface() {
  constexpr double bend = 0.3, steep = 45, degree = std::numbers::pi / 180;
  constexpr Tag last_flat_side = 4;  // flat sides: beneath, and at the other end
  std::vector<Point> outline{{0, 0, 0}};
  const auto go = [&](double degrees, double length) {
    const Point from = outline.back();
    outline.push_back(
        {from.x + length * std::cos(degrees * degree), from.y + length * std::sin(degrees * degree), 0});
  };
  for (int i = 0; i < 10; ++i) go(3 + (steep - 3) * i / 9, bend / 10);
  for (int i = 0; i < 8; ++i) go(steep + 2 * i, 60.0 / 8);
  outline.push_back({outline.back().x, 0, 0});
  std::reverse(outline.begin() + 1, outline.end());
  const PolygonSoup faces = testing::extrusion(outline, 20);
  PolygonSoup soup;
  soup.points = faces.points;
  for (Index p = 0; p < faces.polygon_count(); ++p)
    soup.add_facet(faces.polygon(p), std::min(faces.facet_tag(p), last_flat_side + 1));
  return soup;
}

// The distance bounds the mesh's deviation there.
TEST(ShapeKept, AWedgeAtTheEndOfASurfaceIsNoWall) {
  const PolygonSoup soup = wedge_at_the_end_of_a_surface();
  PipelineOptions options;
  options.mesh = with_size(4);
  SoupPipelineResult made = run_pipeline({&soup, 1}, options);
  ASSERT_EQ(made.missed(), "");
  for (Point& p : made.result.mesh.points)
    if (p.x < 2) p.y *= 0.08;
  const CheckReport report = check(made.result.mesh, made.plc, CheckOptions());
  const auto finds = [&](std::string_view guarantee) {
    return std::ranges::any_of(report.findings,
                               [&](const Finding& finding) { return finding.guarantee == guarantee; });
  };
  EXPECT_FALSE(finds("thickness_kept"));
  EXPECT_TRUE(finds("patch_distance"));
}

}  // namespace
}  // namespace collarmesh::shape_kept_test
