// Sheets and fins outside all regions: no mesh has them, and nothing is refined for them.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>

#include "support/expected_counts.h"
#include "support/meshing.h"
#include "support/plc_shapes.h"
#include "support/shapes.h"

namespace collarmesh::features_outside_test {
namespace {

using namespace collarmesh::testing;

constexpr Tag sheet_tag = 90;

void add_triangle(PolygonSoup& soup, const Point& a, const Point& b, const Point& c) {
  std::array<Index, 3> corners{};
  for (std::size_t i = 0; i < 3; ++i) {
    corners[i] = static_cast<Index>(soup.points.size());
    soup.points.push_back(std::array{a, b, c}[i]);
  }
  soup.add_facet(corners, sheet_tag);
}

bool tells_of_outside(const Plc& plc) {
  return std::any_of(plc.warnings.begin(), plc.warnings.end(), [](const Plc::Warning& warning) {
    return warning.message.find("bounds no region and is not meshed") != std::string::npos;
  });
}

bool has_tag(const TetMesh& mesh, Tag tag) {
  return std::find(mesh.face_tag.begin(), mesh.face_tag.end(), tag) != mesh.face_tag.end();
}

void expect_left_out(const PolygonSoup& soup) {
  const Meshed meshed = mesh_of(soup, with_size(0.4));
  EXPECT_EQ(faults(meshed), "");
  EXPECT_TRUE(tells_of_outside(meshed.plc));
  EXPECT_FALSE(has_tag(meshed.result.mesh, sheet_tag));
  for (Tag side = 1; side <= 6; ++side) EXPECT_TRUE(has_tag(meshed.result.mesh, side)) << side;
  expect_count("features outside/inserted", meshed.result.statistics.vertices_inserted);
}

// Loose triangles have acute corners. Collars for these would have a surface that refinement never resolves.
TEST(FeaturesOutside, LooseTrianglesAreLeftOut) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(0, 1);
  for (int trial = 0; trial < 40; ++trial) {
    SCOPED_TRACE(trial);
    PolygonSoup soup = box();
    const double size = trial % 2 == 0 ? 0.05 : 0.3;
    const Point at{1.4, place(random), place(random)};
    const auto corner = [&] { return at + size * Vector{place(random), place(random), place(random)}; };
    add_triangle(soup, corner(), corner(), corner());
    expect_left_out(soup);
  }
}

TEST(FeaturesOutside, FinsAreLeftOut) {
  PolygonSoup on_an_edge = box();
  add_triangle(on_an_edge, {1, 0, 1}, {1, 1, 1}, {1.5, 0.2, 1.5});
  expect_left_out(on_an_edge);
  PolygonSoup in_a_point = box();
  add_triangle(in_a_point, {1, 1, 1}, {1.6, 1.5, 1.1}, {1.5, 1.6, 1.2});
  expect_left_out(in_a_point);
}

// The surface distance is given by triangles of the whole complex, in which triangles outside come first
// here.
TEST(FeaturesOutside, DistancesAreThoseOfTheTrianglesInside) {
  PolygonSoup sheet;
  for (const double x : {-0.5, 0.0, 0.5}) add_triangle(sheet, {x, 2, 2}, {x + 0.3, 2, 2}, {x, 2.3, 2});
  const PolygonSoup soup =
      joined(joined(sheet, icosphere(1, 8)), translated(cylinder(0.05, 2, 32), {1.5, 0, 0}));
  const Plc plc = build_plc({&soup, 1});
  ASSERT_TRUE(tells_of_outside(plc));
  MeshOptions options = with_size(0.5);
  options.bounds.tolerance = default_tolerance(plc, 0.5);
  ASSERT_TRUE(options.bounds.tolerance->varies());
  EXPECT_EQ(faults(mesh_of(plc, options)), "");
}

// The balls of a crease need no distance from features outside.
TEST(FeaturesOutside, CollarsAreNoSmallerForThem) {
  const PolygonSoup alone = wedge(20, 1);
  PolygonSoup soup = alone;
  add_triangle(soup, {-0.02, 0, 0.3}, {-0.2, 0.1, 0.4}, {-0.3, 0, 0.6});
  const Meshed meshed = mesh_of(soup, with_size(0.4)), without = mesh_of(alone, with_size(0.4));
  EXPECT_EQ(faults(meshed), "");
  EXPECT_TRUE(tells_of_outside(meshed.plc));
  ASSERT_FALSE(meshed.result.mesh.collar_balls.empty());
  const auto largest_radius = [](const Meshed& of) {
    double radius = 0;
    for (const TetMesh::CollarBall& ball : of.result.mesh.collar_balls)
      radius = std::max(radius, ball.radius);
    return radius;
  };
  EXPECT_NEAR(largest_radius(meshed), largest_radius(without), 1e-3 * largest_radius(without));
}

TEST(FeaturesOutside, ThoseInsideStay) {
  PolygonSoup soup = box();
  add_triangle(soup, {0.3, 0.3, 0.4}, {0.7, 0.35, 0.5}, {0.4, 0.6, 0.45});
  const Meshed meshed = mesh_of(soup, with_size(0.4));
  EXPECT_EQ(faults(meshed), "");
  EXPECT_FALSE(tells_of_outside(meshed.plc));
  EXPECT_TRUE(has_tag(meshed.result.mesh, sheet_tag));
}

bool tells_of(const CheckReport& report, const std::string& kind) {
  return std::any_of(report.warnings.begin(), report.warnings.end(), [&](const std::string& warning) {
    return warning.find(kind + " outside of every region are not meshed: ") == 0;
  });
}

PolygonSoup box_with_line(const Point& a, const Point& b) {
  PolygonSoup soup = box();
  soup.points.push_back(a);
  soup.points.push_back(b);
  soup.segments.push_back({8, 9, 5});
  return soup;
}

// No mesh has these lines, and they belong to no sheet that the complex warns of.
TEST(FeaturesOutside, LinesAreTold) {
  const Meshed outside = mesh_of(box_with_line({2, 0.5, 0.5}, {3, 0.5, 0.5}), with_size(0.5));
  EXPECT_EQ(faults(outside), "");
  EXPECT_TRUE(tells_of(outside.report, "Curves"));
  EXPECT_FALSE(tells_of(outside.report, "Vertices"));  // vertices that are ends of the line
  ASSERT_EQ(outside.report.warnings.size(), 1U);
  EXPECT_NE(outside.report.warnings[0].find("(tag 5) at (2, 0.5, 0.5)"), std::string::npos)
      << outside.report.warnings[0];
  EXPECT_TRUE(outside.result.mesh.edge_tag.end() ==
              std::find(outside.result.mesh.edge_tag.begin(), outside.result.mesh.edge_tag.end(), 5));
  const Meshed inside = mesh_of(box_with_line({0.3, 0.5, 0.5}, {0.7, 0.5, 0.5}), with_size(0.5));
  EXPECT_EQ(faults(inside), "");
  EXPECT_FALSE(tells_of(inside.report, "Curves"));
}

TEST(FeaturesOutside, LinesInHolesAreTold) {
  PolygonSoup soup = joined(box_with_line({0.45, 0.5, 0.5}, {0.55, 0.5, 0.5}),
                            translated(scaled(box(), 0.4), {0.3, 0.3, 0.3}));
  soup.hole_points.push_back({0.4, 0.4, 0.4});
  const Meshed meshed = mesh_of(soup, with_size(0.5));
  EXPECT_EQ(faults(meshed), "");
  EXPECT_TRUE(tells_of(meshed.report, "Curves"));
}

TEST(FeaturesOutside, PointsAreTold) {
  PolygonSoup soup = box();
  for (const Point& p : {Point{1.5, 0.5, 0.5}, Point{0.5, 0.5, 0.5}}) {
    soup.vertices.push_back(static_cast<Index>(soup.points.size()));
    soup.points.push_back(p);
  }
  const Meshed meshed = mesh_of(soup, with_size(0.5));
  EXPECT_EQ(faults(meshed), "");
  ASSERT_TRUE(tells_of(meshed.report, "Vertices"));
  EXPECT_NE(meshed.report.warnings[0].find("not meshed: 1 in all, of which the first is"), std::string::npos)
      << meshed.report.warnings[0];
}

// Numbers of features refer to the whole complex, in which patches outside come first here.
TEST(FeaturesOutside, NumbersOfFeaturesAreThoseOfTheComplex) {
  PolygonSoup soup;
  add_triangle(soup, {1.5, 0.2, 0.3}, {1.6, 0.2, 0.31}, {1.5, 0.3, 0.29});
  const Meshed meshed = mesh_of(joined(soup, box()), with_size(0.4));
  EXPECT_EQ(faults(meshed), "");
  const TetMesh& mesh = meshed.result.mesh;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f)
    EXPECT_EQ(meshed.plc.patches[mesh.face_patch[f]].tag, mesh.face_tag[f]);
  for (std::size_t e = 0; e < mesh.edges.size(); ++e)
    EXPECT_EQ(meshed.plc.curves[mesh.edge_curve[e]].tag, mesh.edge_tag[e]);
  for (std::size_t v = 0; v < mesh.points.size(); ++v) {
    const auto [dimension, feature] = mesh.features[v];
    if (dimension == 0) {
      EXPECT_EQ(meshed.plc.points[meshed.plc.vertices[feature].point], mesh.points[v]);
    }
    if (dimension == 2) {
      const Plc::Patch& patch = meshed.plc.patches[feature];
      EXPECT_NEAR(dot(mesh.points[v] - patch.origin, patch.normal), 0, 1e-12);
    }
  }
}

}  // namespace
}  // namespace collarmesh::features_outside_test
