// A mesh of another program, without the complex's labels, is judged by positions.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <set>

#include "check/guarantees.h"
#include "check/region_locator.h"
#include "collarmesh/check.h"
#include "support/meshes.h"

namespace collarmesh::check_placing_test {
namespace {

using namespace collarmesh::testing;
using Names = std::set<std::string>;

Names broken(const TetMesh& mesh, const Plc& plc,
             const CheckOptions& options = {.bounds = {.distance = 0.05}}) {
  Names names;
  for (const Finding& f : check(mesh, plc, options).findings) names.insert(f.guarantee);
  return names;
}

std::vector<MeshedComplex> samples() {
  return {meshed_box(3), meshed_two_boxes(2), meshed_box_with_facet(4), meshed_ball(4, 4),
          meshed_cylinder(12, 4)};
}

TetMesh with_strange_tags(const MeshedComplex& m) {
  TetMesh mesh = without_features(m.mesh);
  for (Tag& tag : mesh.tet_tag) tag += 700;
  for (Index& region : mesh.tet_region) region += 3;
  for (auto& regions : mesh.face_regions)
    for (Index& region : regions) region += region == 0 ? 0 : 3;
  for (Tag& tag : mesh.face_tag) tag = 900 - tag;
  for (Tag& tag : mesh.edge_tag) tag = 1234;
  return mesh;
}

TetMesh without_faces(TetMesh mesh) {
  mesh.faces.clear();
  mesh.face_regions.clear();
  mesh.face_patch.clear();
  mesh.face_tag.clear();
  return mesh;
}

TetMesh without_edges(TetMesh mesh) {
  mesh.edges.clear();
  mesh.edge_curve.clear();
  mesh.edge_tag.clear();
  return mesh;
}

TEST(CheckPlacing, StrangeTags) {
  for (const MeshedComplex& m : samples()) {
    const CheckReport report = check(with_strange_tags(m), m.plc, {.bounds = {.distance = 0.05}});
    EXPECT_TRUE(report.passed()) << report.findings.front().message;
    EXPECT_EQ(report.faces, m.mesh.faces.size());
    EXPECT_EQ(report.edges, m.mesh.edges.size());
    EXPECT_FALSE(report.notes.empty());
  }
}

TEST(CheckPlacing, NoFacesOrNoEdges) {
  for (const MeshedComplex& m : samples()) {
    const TetMesh mesh = without_features(m.mesh);
    EXPECT_EQ(broken(without_faces(mesh), m.plc), Names{});
    EXPECT_EQ(broken(without_edges(mesh), m.plc), Names{});
    EXPECT_EQ(broken(without_faces(without_edges(mesh)), m.plc), Names{});
    EXPECT_EQ(broken(without_faces(without_edges(with_strange_tags(m))), m.plc), Names{});
  }
}

TEST(CheckPlacing, OneTagForTwoRegions) {
  const MeshedComplex m = meshed_two_boxes(3);
  TetMesh mesh = without_faces(without_edges(without_features(m.mesh)));
  mesh.tet_region.assign(mesh.tets.size(), 1);
  mesh.tet_tag.assign(mesh.tets.size(), 42);
  const CheckReport report = check(mesh, m.plc);
  EXPECT_TRUE(report.passed()) << report.findings.front().message;
  EXPECT_NEAR(report.region_volumes[1], report.region_volumes[2], 1e-12);
}

TEST(CheckPlacing, LabelsInMemoryCount) {
  const MeshedComplex m = meshed_box(2);
  EXPECT_NE(broken(without_edges(m.mesh), m.plc), Names{}) << "the mesher lists edges and faces";
  EXPECT_NE(broken(without_faces(m.mesh), m.plc), Names{});
}

TEST(CheckPlacing, FaultsAreStillFound) {
  const MeshedComplex m = meshed_two_boxes(4);
  const TetMesh strange = without_faces(without_edges(with_strange_tags(m)));
  EXPECT_EQ(broken(strange, m.plc, {.bounds = {.radius_edge = 0.8, .thin_angle = 0}}),
            Names{guarantee::radius_edge});
  TetMesh mesh = strange;
  mesh.tets.pop_back();
  mesh.tet_region.pop_back();
  mesh.tet_tag.pop_back();
  mesh.tet_collar.pop_back();
  mesh.tet_crease.pop_back();
  EXPECT_EQ(broken(mesh, m.plc).count(guarantee::region_volume), 1U);
  mesh = strange;
  for (Point& p : mesh.points) p = p + Point{0.01, 0, 0};
  EXPECT_EQ(broken(mesh, m.plc).count(guarantee::vertex_present), 1U);
  for (Point& p : mesh.points) p = 1000 * p + Point{100, 100, 100};
  EXPECT_EQ(broken(mesh, m.plc), Names{guarantee::region_volume}) << "all tets are outside";
}

TEST(CheckPlacing, CreasesExcuseWhatTouchesThem) {
  const MeshedComplex m = meshed_box(4);  // all twelve edges are creases for angles below 91 degrees
  const TetMesh mesh = without_features(m.mesh);
  const CheckOptions creases{.bounds = {.radius_edge = 0.1, .thin_angle = 0, .crease_angle = 91}};
  const CheckReport report = check(mesh, m.plc, creases);
  EXPECT_GT(report.collar_tets, 0U);
  EXPECT_EQ(report.findings_total, report.tets - report.collar_tets);
  EXPECT_EQ(broken(mesh, m.plc, {.bounds = {.collar_angle = 89, .crease_angle = 91}}),
            Names{guarantee::collar_dihedral});
  EXPECT_EQ(broken(mesh, m.plc, {.bounds = {.collar_angle = 89}}), Names{})
      << "without creases there are no collars";
}

TEST(CheckPlacing, MarksAloneExcuseNothing) {
  MeshedComplex m = meshed_box(4);
  m.mesh.tet_collar.assign(m.mesh.tets.size(), 1);
  const CheckOptions strict{.bounds = {.radius_edge = 0.1, .thin_angle = 0}};
  EXPECT_EQ(broken(m.mesh, m.plc, strict), (Names{guarantee::collar_cells, guarantee::radius_edge}));
  const CheckReport report = check(without_features(m.mesh), m.plc, strict);
  EXPECT_EQ(report.collar_tets, 0U);
  EXPECT_EQ(report.findings_total, 2 * report.tets);
}

TEST(RegionLocator, Sphere) {
  const MeshedComplex m = meshed_ball(3, 8);
  const checks::RegionLocator locator(m.plc);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> coordinate(-1.5, 1.5);
  for (int i = 0; i < 2000; ++i) {
    const Point p{coordinate(random), coordinate(random), coordinate(random)};
    if (norm(p) > 0.99 && norm(p) < 1) continue;
    EXPECT_EQ(locator.region_at(p), norm(p) < 1 ? 1U : 0U);
  }
  EXPECT_EQ(locator.region_at({}), 1U);
}

// Gmsh lists the edges along which it divides faces; without tags nothing distinguishes them from edges on
// curves.
TEST(CheckPlacing, EdgesOnNoCurve) {
  MeshedComplex m = meshed_box(3);
  for (Plc::Curve& curve : m.plc.curves) curve.tag = 0;
  TetMesh mesh = without_features(m.mesh);
  for (Tag& tag : mesh.edge_tag) tag = 0;
  const auto on_curve = mesh.edges;
  const auto listed = [&](Index a, Index b) {
    return std::any_of(on_curve.begin(), on_curve.end(),
                       [&](const auto& e) { return (e[0] == a && e[1] == b) || (e[0] == b && e[1] == a); });
  };
  for (unsigned i = 0; i < 3; ++i) {
    const auto& face = mesh.faces[4];
    if (listed(face[i], face[(i + 1) % 3])) continue;
    mesh.edges.push_back({face[i], face[(i + 1) % 3]});
    mesh.edge_curve.push_back(none);
    mesh.edge_tag.push_back(0);
  }
  ASSERT_GT(mesh.edges.size(), on_curve.size());
  const CheckReport report = check(mesh, m.plc, {.bounds = {.distance = 0.05}});
  EXPECT_TRUE(report.passed()) << report.findings.front().message;
  EXPECT_EQ(report.edges, on_curve.size());
}

// The seam of a round face has a number in CAD files, which no curve of the complex has.
TEST(CheckPlacing, SeamsAreNoCurves) {
  MeshedComplex m = meshed_cylinder(12, 4);
  m.plc.numbered_curves = false;
  TetMesh mesh = without_features(m.mesh);
  ASSERT_NE(m.plc.curves[0].tag, m.plc.curves[1].tag);
  const std::size_t on_curves = mesh.edges.size();
  const Point& a = mesh.points[mesh.edges[0][0]];
  const auto above = std::find_if(mesh.points.begin(), mesh.points.end(), [&](const Point& p) {
    return p.z == 1 - a.z && distance(p, {a.x, a.y, 1 - a.z}) < 1e-9;
  });
  ASSERT_NE(above, mesh.points.end());
  mesh.edges.push_back({mesh.edges[0][0], static_cast<Index>(above - mesh.points.begin())});
  mesh.edge_curve.push_back(none);
  mesh.edge_tag.push_back(77);
  const CheckReport report = check(mesh, m.plc, {.bounds = {.distance = 0.05}});
  EXPECT_TRUE(report.passed()) << report.findings.front().message;
  EXPECT_EQ(report.edges, on_curves);
  mesh.edge_tag.back() = m.plc.curves[0].tag;
  EXPECT_NE(broken(mesh, m.plc), Names{}) << "an edge with the tag of a curve has to be on it";
}

// Nodes of other programs are on exact circles, a little off the complex's polylines.
TEST(CheckPlacing, FacesTellTheCurvesBetweenThem) {
  MeshedComplex m = meshed_cylinder(12, 4);
  for (Index p = 0; p < m.plc.patches.size(); ++p) m.plc.patches[p].tag = static_cast<Tag>(p + 1);
  for (Index f = 0; f < m.mesh.faces.size(); ++f)
    m.mesh.face_tag[f] = m.plc.patches[m.mesh.face_patch[f]].tag;
  TetMesh mesh = without_edges(without_features(m.mesh));
  for (Point& p : mesh.points)
    if (std::hypot(p.x, p.y) > 0.5) p.x *= 1.001, p.y *= 1.001;
  const CheckReport report = check(mesh, m.plc, {.bounds = {.distance = 0.05}});
  EXPECT_TRUE(report.passed()) << report.findings.front().message;
  EXPECT_EQ(report.edges, m.mesh.edges.size());
}

TEST(RegionLocator, PlacesInThePlanesOfTheFacets) {
  const MeshedComplex m = meshed_two_boxes(1);
  const checks::RegionLocator locator(m.plc);
  Box box;
  for (const Point& p : m.plc.points) box.add(p);
  for (double s = -0.9; s < 2; s += 0.1) {
    const Point beyond{box.min.x - 1 - s * s, box.min.y, box.min.z + s};
    EXPECT_EQ(locator.region_at(beyond), 0U);
  }
  for (Index t = 0; t < m.mesh.tets.size(); ++t) {
    Point centre;
    for (const Index p : m.mesh.tets[t]) centre = centre + 0.25 * m.mesh.points[p];
    EXPECT_EQ(locator.region_at(centre), m.mesh.tet_region[t]);
  }
}

}  // namespace
}  // namespace collarmesh::check_placing_test
