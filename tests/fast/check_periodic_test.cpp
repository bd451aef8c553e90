// The certificate of periodic faces: correct ones pass, and every fault is named, with its place.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>
#include <string>

#include "check/periodic.h"
#include "collarmesh/check.h"
#include "collarmesh/second_order.h"
#include "support/meshes.h"
#include "support/periodic.h"

namespace collarmesh::check_periodic_test {
namespace {

using namespace collarmesh::testing;
using namespace collarmesh::guarantee;
using Names = std::set<std::string>;

CheckReport report_of(const TetMesh& mesh) {
  CheckReport report;
  checks::check_periodic(mesh, report);
  return report;
}

Names broken(const TetMesh& mesh) {
  Names names;
  for (const Finding& finding : report_of(mesh).findings) names.insert(finding.guarantee);
  return names;
}

TetMesh periodic_box(Index n = 3, unsigned order = 1) {
  MeshedComplex made = meshed_box(n);
  if (order == 2) make_second_order(made.mesh, made.plc);
  make_box_periodic(made.mesh, {1, 1, 1});
  return made.mesh;
}

void move_everything(TetMesh& mesh, const Vector& by) {
  for (Point& p : mesh.points) p = p + by;
}

Index inner_node(const TetMesh& mesh, std::size_t pair) {
  for (const auto& [node, image] : mesh.periodic[pair].nodes)
    if (mesh.features[node].dimension == 2) return node;
  ADD_FAILURE() << "no node inside of a face";
  return 0;
}

Index image_of(const TetMesh& mesh, std::size_t pair, Index node) {
  for (const auto& [from, to] : mesh.periodic[pair].nodes)
    if (from == node) return to;
  ADD_FAILURE() << "no image";
  return 0;
}

TEST(CheckPeriodic, RightMapsPass) {
  EXPECT_EQ(report_of(meshed_box(2).mesh).findings_total, 0U) << "nothing is periodic";
  for (const unsigned order : {1U, 2U})
    for (const Index n : {1U, 3U}) {
      const CheckReport report = report_of(periodic_box(n, order));
      EXPECT_TRUE(report.passed()) << report.findings.front().message;
    }
}

TEST(CheckPeriodic, RoundingIsAllowedWhereTheMeshLiesFarAway) {
  for (const double far : {1e3, 1e6, 1e9}) {
    MeshedComplex made = meshed_box(3);
    move_everything(made.mesh, {far / 3, -far / 7, far / 11});
    make_box_periodic(made.mesh, {1, 1, 1});
    EXPECT_EQ(broken(made.mesh), Names()) << far;
  }
}

TEST(CheckPeriodic, ATurnedFaceAndItsAxisPass) {
  TetMesh mesh;
  mesh.points = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0.5}, {0, 1, 0.5}};
  mesh.tets = {{0, 1, 3, 2}};
  mesh.faces = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  mesh.face_tag = {1, 2, 3, 4};
  mesh.edges = {{0, 1}, {2, 0}, {3, 0}};
  mesh.periodic = {mapped_faces(mesh, {1}, {2}, quarter_turn())};
  EXPECT_EQ(mesh.periodic[0].nodes, (std::vector<std::array<Index, 2>>{{0, 0}, {1, 1}, {2, 3}}));
  EXPECT_EQ(broken(mesh), Names());
  mesh.edges.pop_back();
  EXPECT_EQ(broken(mesh), Names{periodic_edges});
}

TEST(CheckPeriodic, AMovedNodeIsFarFromTheImage) {
  for (const double distance : {1e-3, 1e-14}) {
    TetMesh mesh = periodic_box();
    const Index node = image_of(mesh, 0, inner_node(mesh, 0));
    mesh.points[node].y += distance;
    const CheckReport report = report_of(mesh);
    ASSERT_EQ(report.findings_total, 1U) << distance;
    EXPECT_EQ(report.findings[0].guarantee, periodic_places);
    EXPECT_EQ(report.findings[0].where, mesh.points[node]);
    EXPECT_EQ(report.findings[0].ids.back(), node);
  }
}

TEST(CheckPeriodic, ANodeLeftOutHasNoImage) {
  TetMesh mesh = periodic_box();
  const Index node = inner_node(mesh, 1);
  std::erase_if(mesh.periodic[1].nodes, [&](const auto& each) { return each[0] == node; });
  EXPECT_EQ(broken(mesh), (Names{periodic_nodes, periodic_faces})) << "faces at it have no image either";
}

TEST(CheckPeriodic, SwappedImages) {
  TetMesh mesh = periodic_box();
  auto& nodes = mesh.periodic[2].nodes;
  std::swap(nodes[0][1], nodes[1][1]);
  const Names names = broken(mesh);
  EXPECT_TRUE(names.contains(periodic_places));
  EXPECT_TRUE(names.contains(periodic_faces));
  EXPECT_TRUE(names.contains(periodic_corners)) << "the nodes are at edges of the cell";
  EXPECT_FALSE(names.contains(periodic_nodes)) << "it is one to one";
}

TEST(CheckPeriodic, TwoNodesOntoOne) {
  TetMesh mesh = periodic_box();
  mesh.periodic[0].nodes[1][1] = mesh.periodic[0].nodes[0][1];
  EXPECT_TRUE(broken(mesh).contains(periodic_nodes));
}

TEST(CheckPeriodic, NodesOffTheFacesAndOutOfRange) {
  TetMesh mesh = periodic_box();
  const Index inside = static_cast<Index>(std::find_if(mesh.features.begin(), mesh.features.end(),
                                                       [](const auto& f) { return f.dimension == 3; }) -
                                          mesh.features.begin());
  mesh.periodic[0].nodes.push_back({inside, inside});
  EXPECT_EQ(broken(mesh), (Names{periodic_nodes, periodic_places}));
  mesh.periodic[0].nodes.back() = {0, static_cast<Index>(mesh.points.size())};
  EXPECT_EQ(broken(mesh), Names{periodic_nodes});
}

TEST(CheckPeriodic, AFlippedEdgeHasTrianglesWithoutImages) {
  TetMesh mesh = periodic_box();
  // The two triangles of a square on the side x = 1 get the other diagonal.
  Index f = 0, g = 0;
  for (f = 0; f < mesh.faces.size(); ++f) {
    if (mesh.face_tag[f] != 2) continue;
    for (g = f + 1; g < mesh.faces.size(); ++g) {
      std::set<Index> corners(mesh.faces[f].begin(), mesh.faces[f].end());
      corners.insert(mesh.faces[g].begin(), mesh.faces[g].end());
      if (mesh.face_tag[g] == 2 && corners.size() == 4) break;
    }
    if (g < mesh.faces.size()) break;
  }
  ASSERT_LT(g, mesh.faces.size());
  while (std::count(mesh.faces[g].begin(), mesh.faces[g].end(), mesh.faces[f][0]) > 0)
    std::rotate(mesh.faces[f].begin(), mesh.faces[f].begin() + 1, mesh.faces[f].end());
  while (std::count(mesh.faces[f].begin(), mesh.faces[f].end(), mesh.faces[g][0]) > 0)
    std::rotate(mesh.faces[g].begin(), mesh.faces[g].begin() + 1, mesh.faces[g].end());
  const Index a = mesh.faces[f][0], b = mesh.faces[f][1], c = mesh.faces[g][0], d = mesh.faces[f][2];
  mesh.faces[f] = {a, b, c};
  mesh.faces[g] = {a, c, d};
  const CheckReport report = report_of(mesh);
  EXPECT_EQ(broken(mesh), Names{periodic_faces});
  EXPECT_EQ(report.findings_total, 4U) << "two without an image, two that are no image";
}

TEST(CheckPeriodic, ImagesLookTheOtherWay) {
  TetMesh mesh = periodic_box();
  for (std::size_t f = 0; f < mesh.faces.size(); ++f)
    if (mesh.face_tag[f] == 2) std::swap(mesh.faces[f][1], mesh.faces[f][2]);
  EXPECT_EQ(broken(mesh), Names{periodic_faces});
}

TEST(CheckPeriodic, EdgesOnCurvesAreMapped) {
  for (const bool on_first : {true, false}) {
    TetMesh mesh = periodic_box();
    mesh.periodic.resize(1);
    const double x = on_first ? 0 : 1;
    for (std::size_t e = 0; e < mesh.edges.size(); ++e) {
      const auto [a, b] = mesh.edges[e];
      if (mesh.points[a].x != x || mesh.points[b].x != x) continue;
      mesh.edges.erase(mesh.edges.begin() + static_cast<std::ptrdiff_t>(e));
      break;
    }
    const CheckReport report = report_of(mesh);
    ASSERT_EQ(report.findings_total, 1U);
    EXPECT_EQ(report.findings[0].guarantee, periodic_edges);
  }
}

TEST(CheckPeriodic, MidEdgeNodesAreMapped) {
  TetMesh mesh = periodic_box(2, 2);
  for (auto& [node, image] : mesh.periodic[0].nodes) {
    if (node < 27) continue;  // a corner
    auto& other = mesh.periodic[0].nodes.back();
    std::swap(image, other[1]);
    break;
  }
  const Names names = broken(mesh);
  EXPECT_TRUE(names.contains(periodic_places));
  EXPECT_TRUE(names.contains(periodic_faces));
}

TEST(CheckPeriodic, MotionsAreRigid) {
  TetMesh mesh = periodic_box();
  mesh.periodic.resize(1);
  mesh.periodic[0].motion.rows[1] = {0, 1, 1e-12};
  EXPECT_TRUE(broken(mesh).contains(periodic_motion));
  mesh = periodic_box();
  mesh.periodic.resize(1);
  mesh.periodic[0].motion.rows[0] = {-1, 0, 0};
  EXPECT_EQ(broken(mesh), Names{periodic_motion}) << "the plane x = 0 is the same in a mirror";
}

TEST(CheckPeriodic, UnknownTagsHaveNoTriangles) {
  TetMesh mesh = periodic_box();
  mesh.periodic = {{{70}, {80}, translation({1, 0, 0}), {}}};
  EXPECT_EQ(broken(mesh), Names{periodic_nodes});
}

}  // namespace
}  // namespace collarmesh::check_periodic_test
