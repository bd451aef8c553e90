// Curves on their own, and some patches of a complex, judged by formulas of this file.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <vector>

#include "collarmesh/error.h"
#include "collarmesh/plc_builder.h"
#include "collarmesh/shells.h"
#include "support/any_complex.h"
#include "support/shapes.h"

namespace collarmesh::lines_test {
namespace {

using namespace testing;

PipelineOptions lines(double size, unsigned order = 1) {
  PipelineOptions options;
  options.dimension = 1;
  options.mesh.size = size;
  options.order = order;
  return options;
}

/// Two straight lines and between them a half circle of radius 1, of many segments.
PolygonSoup hook() {
  PolygonSoup soup;
  const auto add = [&](const Point& p) {
    soup.points.push_back(p);
    return static_cast<Index>(soup.points.size() - 1);
  };
  Index before = add({-5, -1, 0});
  const auto go = [&](const Point& p, Tag tag) {
    const Index next = add(p);
    soup.segments.push_back({before, next, tag});
    before = next;
  };
  go({0, -1, 0}, 1);
  constexpr int parts = 200;
  for (int i = 1; i <= parts; ++i) {
    const double a = std::numbers::pi * (i / double{parts} - 0.5);
    go(i == parts ? Point{0, 1, 0} : Point{std::cos(a), std::sin(a), 0}, 2);
  }
  go({-3, 1, 0}, 3);
  soup.vertices = {0, 1, static_cast<Index>(parts + 1), before};
  soup.given_features = true;
  return soup;
}

double length_of(const TetMesh& mesh, Tag tag) {
  double length = 0;
  for (std::size_t e = 0; e < mesh.edges.size(); ++e) {
    if (mesh.edge_tag[e] != tag) continue;
    const auto& [a, b] = mesh.edges[e];
    length += distance(mesh.points[a], mesh.points[b]);
  }
  return length;
}

TEST(Lines, CurvesAreChainsOfEdgesOfTheSize) {
  for (const double size : {1.0, 0.3, 0.1}) {
    const Plc plc = complex_of(hook());
    const PipelineResult made = mesh_shells(plc, lines(size));
    EXPECT_TRUE(made.guarantees_hold()) << made.missed();
    const TetMesh& mesh = made.result.mesh;
    EXPECT_TRUE(mesh.is_curves());
    EXPECT_EQ(mesh.points.size(), mesh.edges.size() + 1);  // one open chain
    std::vector<int> degree(mesh.points.size(), 0);
    for (const auto& [a, b] : mesh.edges) {
      EXPECT_LT(distance(mesh.points[a], mesh.points[b]), 1.4 * size);
      ++degree[a];
      ++degree[b];
    }
    EXPECT_EQ(std::count(degree.begin(), degree.end(), 1), 2);
    EXPECT_EQ(std::count(degree.begin(), degree.end(), 2), std::ssize(degree) - 2);
    EXPECT_NEAR(length_of(mesh, 1), 5, 1e-12);
    EXPECT_NEAR(length_of(mesh, 3), 3, 1e-12);
    EXPECT_NEAR(length_of(mesh, 2), std::numbers::pi, 0.2 * size * size + 1e-3);
    for (std::size_t p = 0; p < mesh.points.size(); ++p)
      if (mesh.points[p].x > 1e-9) {
        EXPECT_NEAR(norm(mesh.points[p]), 1, 1e-4);
      }
  }
}

TEST(Lines, MiddleNodesFollowTheCurve) {
  const PipelineResult made = mesh_shells(complex_of(hook()), lines(0.4, 2));
  EXPECT_TRUE(made.guarantees_hold()) << made.missed();
  const TetMesh& mesh = made.result.mesh;
  ASSERT_EQ(mesh.order(), 2);
  ASSERT_EQ(mesh.edge_mid_nodes.size(), mesh.edges.size());
  for (std::size_t e = 0; e < mesh.edges.size(); ++e) {
    const Point &a = mesh.points[mesh.edges[e][0]], &b = mesh.points[mesh.edges[e][1]],
                &m = mesh.points[mesh.edge_mid_nodes[e]];
    EXPECT_NEAR(mesh.edge_tag[e] == 2 ? norm(m) - 1 : distance(m, 0.5 * (a + b)), 0,
                mesh.edge_tag[e] == 2 ? 1e-4 : 1e-12);
  }
}

TEST(Lines, ClosedCurvesAndCurvesOfSurfaces) {
  const PipelineResult made = mesh_shells(complex_of(box({0, 0, 0}, {1, 1, 1}, 3)), lines(0.25));
  EXPECT_TRUE(made.guarantees_hold()) << made.missed();
  EXPECT_EQ(made.result.mesh.edges.size(), 12U * 4);
  const PipelineResult round = mesh_shells(complex_of(cylinder(1, 2, 60)), lines(0.2));
  EXPECT_TRUE(round.guarantees_hold()) << round.missed();
  const TetMesh& mesh = round.result.mesh;
  EXPECT_EQ(mesh.points.size(), mesh.edges.size());  // two circles
  EXPECT_THROW(mesh_shells(complex_of(icosphere(1, 4)), lines(0.2)), PlcError);
}

TEST(Lines, TheCertificateFindsFaults) {
  const Plc plc = complex_of(hook());
  const PipelineOptions options = lines(0.4, 2);
  const TetMesh good = mesh_shells(plc, options).result.mesh;
  const auto findings = [&](const TetMesh& mesh) {
    std::set<std::string> found;
    for (const Finding& finding : check_lines(mesh, plc).findings) found.insert(finding.guarantee);
    return found;
  };
  EXPECT_TRUE(findings(good).empty());
  TetMesh bad = good;
  bad.points[good.edges[3][1]].z += 0.5;
  EXPECT_TRUE(findings(bad).count("curve_distance") == 1);
  bad = good;
  bad.edge_tag[0] = 9;
  EXPECT_TRUE(findings(bad).count("curve_tag") == 1);
  bad = good;
  bad.edges.pop_back();
  bad.edge_curve.pop_back();
  bad.edge_tag.pop_back();
  bad.edge_mid_nodes.pop_back();
  EXPECT_FALSE(findings(bad).empty());
  bad = good;
  bad.points[good.edge_mid_nodes[0]] =
      good.points[good.edges[0][0]] + 0.1 * (good.points[good.edges[0][1]] - good.points[good.edges[0][0]]);
  EXPECT_EQ(findings(bad), std::set<std::string>{"positive_jacobian"});
  bad = good;
  for (std::size_t e = bad.edges.size(); e-- > 0;)
    if (bad.edge_tag[e] == 3) {
      bad.edges.erase(bad.edges.begin() + static_cast<std::ptrdiff_t>(e));
      bad.edge_curve.erase(bad.edge_curve.begin() + static_cast<std::ptrdiff_t>(e));
      bad.edge_tag.erase(bad.edge_tag.begin() + static_cast<std::ptrdiff_t>(e));
      bad.edge_mid_nodes.erase(bad.edge_mid_nodes.begin() + static_cast<std::ptrdiff_t>(e));
    }
  EXPECT_TRUE(findings(bad).count("curve_present") == 1);
}

TEST(ChosenPatches, AreMeshedAlone) {
  PipelineOptions options;
  options.dimension = 2;
  options.mesh.size = 0.2;
  const Plc plc = complex_of(box({0, 0, 0}, {1, 1, 1}, 3));
  std::set<Tag> tags;
  for (const Plc::Patch& patch : plc.patches) tags.insert(patch.tag);
  ASSERT_EQ(tags.size(), 6U);
  const Tag first = *tags.begin(), last = *tags.rbegin();
  options.faces = {std::to_string(first), "patch_" + std::to_string(last)};
  const PipelineResult made = mesh_shells(plc, options);
  EXPECT_TRUE(made.guarantees_hold()) << made.missed();
  const TetMesh& mesh = made.result.mesh;
  EXPECT_EQ(std::set<Tag>(mesh.face_tag.begin(), mesh.face_tag.end()), (std::set<Tag>{first, last}));
  double area = 0;
  for (const auto& [a, b, c] : mesh.faces) {
    const Vector normal = cross(mesh.points[b] - mesh.points[a], mesh.points[c] - mesh.points[a]);
    area += 0.5 * norm(normal);
    const Point middle = (mesh.points[a] + mesh.points[b] + mesh.points[c]) / 3;
    EXPECT_GT(dot(normal, middle - Point{0.5, 0.5, 0.5}), 0) << "it looks out of the solid";
  }
  EXPECT_NEAR(area, 2, 1e-9);
  EXPECT_TRUE(check_faces(mesh, plc, options.faces).passed());
  EXPECT_FALSE(check_faces(mesh, plc, {std::to_string(first)}).passed());
  options.faces = {"lid"};
  EXPECT_THROW(mesh_shells(plc, options), OptionError);
}

TEST(Sheets, AreCutWhereTheyIntersect) {
  PolygonSoup cross;
  cross.points = {{0, 0, 0},     {2, 0, 0},    {2, 2, 0},   {0, 2, 0},
                  {1, -0.5, -1}, {1, 2.5, -1}, {1, 2.5, 1}, {1, -0.5, 1}};
  cross.add_facet(std::vector<Index>{0, 1, 2, 3}, 1);
  cross.add_facet(std::vector<Index>{4, 5, 6, 7}, 2);
  PlcOptions any;
  any.require_solid = false;
  const std::vector<PolygonSoup> soups{cross};
  const RepairedPlc cut = build_repaired_plc(soups, any, {});
  EXPECT_TRUE(cut.report.repaired);
  EXPECT_GT(cut.report.cut.count, 0U);
  EXPECT_TRUE(cut.report.filled.empty());
  double areas[3] = {0, 0, 0};
  for (const Plc::Triangle& t : cut.plc.triangles) {
    const auto& p = cut.plc.points;
    areas[cut.plc.patches[t.patch].tag] +=
        0.5 * norm(collarmesh::cross(p[t.points[1]] - p[t.points[0]], p[t.points[2]] - p[t.points[0]]));
  }
  EXPECT_NEAR(areas[1], 4, 1e-9);
  EXPECT_NEAR(areas[2], 6, 1e-9);
  const PlcOptions solid;
  EXPECT_THROW(build_repaired_plc(soups, solid, {}), PlcError);
}

}  // namespace
}  // namespace collarmesh::lines_test
