// Meshes of second order: certified, with nodes on the smooth features and the volumes of the curved shapes;
// inverted tets are straightened.
#include "collarmesh/second_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <numbers>
#include <optional>
#include <set>

#include "collarmesh/coarsen.h"
#include "collarmesh/curved_tet.h"
#include "collarmesh/error.h"
#include "collarmesh/improve.h"
#include "remesh/shape.h"
#include "support/meshing.h"
#include "support/second_order.h"
#include "support/shapes.h"

namespace collarmesh::second_order_test {
namespace {

using namespace collarmesh::testing;

constexpr double pi = std::numbers::pi;

Meshed improved(const PolygonSoup& soup, double size, double distance = 0) {
  MeshOptions options = with_size(size);
  options.bounds.distance = distance;
  Meshed meshed = mesh_of(soup, options);
  improve(meshed.result.mesh, meshed.plc, {.bounds = without_thin(distance)});
  return meshed;
}

Index vertex_at(const TetMesh& mesh, const Point& p) {
  return static_cast<Index>(std::find(mesh.points.begin(), mesh.points.end(), p) - mesh.points.begin());
}

std::string second_order_faults(const Meshed& meshed, const TetMesh& mesh, double distance = 0) {
  CheckOptions options;
  options.bounds.distance = distance;
  options.findings_per_guarantee = 3;
  std::string text;
  for (const Finding& f : check(mesh, meshed.plc, options).findings)
    text += f.guarantee + ": " + f.message + "\n";
  return text;
}

std::size_t count_edges(const TetMesh& mesh) {
  std::set<std::pair<Index, Index>> edges;
  for (const auto& t : mesh.tets)
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = 0; j < i; ++j) edges.insert(std::minmax(t[i], t[j]));
  return edges.size();
}

/// Returns the exact volume: the integral of the cubic Jacobian by the rule of degree 3 with the centre and
/// the four points on the medians (Keast 1986).
double curved_volume(const TetMesh& mesh) {
  constexpr std::array<std::array<std::size_t, 2>, 6> ends{{{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}};
  double volume = 0;
  for (Index t = 0; t < mesh.tets.size(); ++t) {
    const CurvedTet nodes = curved_tet(mesh, t);
    const auto jacobian = [&](const std::array<double, 4>& l) {
      std::array<Vector, 4> d;
      for (std::size_t i = 0; i < 4; ++i) d[i] = (4 * l[i] - 1) * nodes[i];
      for (std::size_t e = 0; e < 6; ++e) {
        d[ends[e][0]] = d[ends[e][0]] + 4 * l[ends[e][1]] * nodes[4 + e];
        d[ends[e][1]] = d[ends[e][1]] + 4 * l[ends[e][0]] * nodes[4 + e];
      }
      return dot(cross(d[1] - d[0], d[2] - d[0]), d[3] - d[0]);
    };
    double mean = -0.8 * jacobian({0.25, 0.25, 0.25, 0.25});
    for (std::size_t k = 0; k < 4; ++k) {
      std::array<double, 4> l;
      l.fill(1.0 / 6);
      l[k] = 0.5;
      mean += 0.45 * jacobian(l);
    }
    volume += mean / 6;
  }
  return volume;
}

double straight_volume(const TetMesh& mesh) {
  double volume = 0;
  for (const auto& [a, b, c, d] : mesh.tets)
    volume += six_volume(mesh.points[a], mesh.points[b], mesh.points[c], mesh.points[d]) / 6;
  return volume;
}

struct CurvedShape {
  const char* name;
  PolygonSoup soup;
  double size, distance, volume;
};

class SecondOrderShapes : public ::testing::TestWithParam<CurvedShape> {};

TEST_P(SecondOrderShapes, AreCertifiedAndRounderThanStraightOnes) {
  const auto& [name, soup, size, distance, volume] = GetParam();
  const Meshed meshed = improved(soup, size, distance);
  TetMesh mesh = meshed.result.mesh;
  const SecondOrderReport report = make_second_order(mesh, meshed.plc, {.bounds = without_thin()});
  EXPECT_EQ(second_order_faults(meshed, mesh, distance), "");
  EXPECT_EQ(mesh.order(), 2);
  EXPECT_EQ(report.nodes, count_edges(mesh));
  EXPECT_EQ(mesh.points.size(), meshed.result.mesh.points.size() + report.nodes);
  EXPECT_GT(report.curved, 50U);
  EXPECT_LT(report.straightened.size(), report.curved / 50);
  const double straight_error = std::fabs(straight_volume(mesh) - volume);
  const double curved_error = std::fabs(curved_volume(mesh) - volume);
  EXPECT_LT(curved_error, 0.15 * straight_error) << name << ": " << curved_error << " and " << straight_error;
  for (Index t = 0; t < mesh.tets.size(); ++t) EXPECT_TRUE(jacobian_exceeds(curved_tet(mesh, t), 0.1));
}

INSTANTIATE_TEST_SUITE_P(
    Smooth, SecondOrderShapes,
    ::testing::Values(CurvedShape{"ball", icosphere(1, 24), 0.35, 0.05, 4 * pi / 3},
                      CurvedShape{"cylinder", cylinder(1, 2, 160, 12), 0.35, 0.05, 2 * pi},
                      CurvedShape{"torus", torus(2, 0.7, 192, 96), 0.4, 0.05, 2 * pi* pi * 2 * 0.7 * 0.7}),
    [](const auto& shape) { return std::string(shape.param.name); });

TEST(SecondOrder, StaysStraightOnPlanesAndStraightEdges) {
  const Meshed meshed = improved(l_shape(), 0.3);
  TetMesh mesh = meshed.result.mesh;
  const SecondOrderReport report = make_second_order(mesh, meshed.plc, {.bounds = without_thin()});
  EXPECT_EQ(report.curved, 0U);
  EXPECT_EQ(second_order_faults(meshed, mesh), "");
  const TetMesh expected = second_order(meshed.result.mesh);
  ASSERT_EQ(mesh.tets.size(), expected.tets.size());
  for (Index t = 0; t < mesh.tets.size(); ++t) EXPECT_EQ(curved_tet(mesh, t), curved_tet(expected, t));
}

TEST(SecondOrder, ACallerGivesTheExactSurface) {
  const Meshed meshed = improved(icosphere(1, 12), 0.4, 0.05);
  TetMesh mesh = meshed.result.mesh;
  const SecondOrderReport report = make_second_order(mesh, meshed.plc,
                                                     {.exact =
                                                          [](unsigned dimension, Index, const Point& p) {
                                                            EXPECT_EQ(dimension, 2U);
                                                            return p / norm(p);
                                                          },
                                                      .bounds = without_thin()});
  ASSERT_TRUE(report.straightened.empty());
  for (const auto& nodes : mesh.face_mid_nodes)
    for (const Index node : nodes) EXPECT_NEAR(norm(mesh.points[node]), 1, 1e-14);
}

// A projection that goes too far inwards: every tet stays valid, and each node that could not follow is
// reported.
TEST(SecondOrder, WhatWouldInvertIsStraightenedAndReported) {
  const Meshed meshed = improved(icosphere(1, 12), 0.4, 0.05);
  TetMesh mesh = meshed.result.mesh;
  const SecondOrderOptions options{.exact = [](unsigned, Index, const Point& p) { return 0.83 * p; },
                                   .bounds = without_thin()};
  const SecondOrderReport report = make_second_order(mesh, meshed.plc, options);
  EXPECT_GT(report.straightened.size(), 10U);
  for (Index t = 0; t < mesh.tets.size(); ++t)
    EXPECT_TRUE(jacobian_exceeds(curved_tet(mesh, t), options.least_jacobian)) << t;
  std::set<Index> named;
  for (const auto& s : report.straightened) {
    named.insert(s.point);
    EXPECT_EQ(s.where, mesh.points[s.point]);
    EXPECT_EQ(s.tag, meshed.plc.patches[0].tag);
    const Point middle = 0.5 * (mesh.points[s.edge[0]] + mesh.points[s.edge[1]]);
    EXPECT_NEAR(s.distance, distance(s.where, 0.83 * middle), 1e-12);
  }
  for (const auto& nodes : mesh.face_mid_nodes)
    for (const Index node : nodes)
      if (named.count(node) == 0) {
        EXPECT_LT(norm(mesh.points[node]), 0.84);
      }
}

/// A coarse curved mesh: thin tets, with edges that turn by up to an eighth of a circle.
Meshed coarsened(const PolygonSoup& soup, double size) {
  MeshOptions options = with_size(size);
  options.bounds.distance = 0.1 * size;
  Meshed meshed = mesh_of(soup, options);
  coarsen(meshed.result.mesh, meshed.plc, options);
  improve(meshed.result.mesh, meshed.plc, {.bounds = options.bounds, .keep_vertices = true});
  return meshed;
}

// Fewer edges stay straight than without replacements, the surface does not change, and threads change
// nothing.
TEST(SecondOrder, TetsThatCurvedEdgesFlattenAreReplaced) {
  struct Shape {
    PolygonSoup soup;
    double size;
  };
  std::size_t without = 0, with = 0, replaced = 0;
  for (const auto& [soup, size] : {Shape{cylinder(1, 0.3, 120, 4), 0.7}, Shape{torus(1, 0.12, 120, 24), 0.4},
                                   Shape{plate_with_hole(1, 96), 1.5}, Shape{cylinder(1, 3, 120, 12), 0.8}}) {
    const Meshed meshed = coarsened(soup, size);
    const TetMesh& before = meshed.result.mesh;
    TetMesh kept = before, mesh = before, again = before;
    SecondOrderOptions options;
    options.bounds = without_thin(0.1 * size);
    without += make_second_order(kept, meshed.plc, options).straightened.size();
    EXPECT_EQ(kept.tets, before.tets);
    options.bounds.thin_angle = 8;
    options.threads = 1;
    const SecondOrderReport report = make_second_order(mesh, meshed.plc, options);
    with += report.straightened.size();
    EXPECT_EQ(second_order_faults(meshed, mesh, options.bounds.distance), "");
    for (Index t = 0; t < mesh.tets.size(); ++t) EXPECT_TRUE(jacobian_exceeds(curved_tet(mesh, t), 0.1)) << t;
    EXPECT_EQ(report.more_tets, static_cast<std::ptrdiff_t>(mesh.tets.size()) -
                                    static_cast<std::ptrdiff_t>(before.tets.size()));
    replaced += mesh.tets != before.tets ? 1 : 0;
    for (Index v = 0; v < before.points.size(); ++v) {
      EXPECT_EQ(mesh.features[v].dimension, before.features[v].dimension);
      EXPECT_EQ(mesh.features[v].feature, before.features[v].feature);
      if (before.features[v].dimension < 3) {
        EXPECT_EQ(mesh.points[v], before.points[v]);
      }
    }
    options.threads = 3;
    make_second_order(again, meshed.plc, options);
    EXPECT_EQ(again.points, mesh.points);
    EXPECT_EQ(again.tets, mesh.tets);
  }
  EXPECT_GT(replaced, 0U);
  EXPECT_GT(without, 10U);
  EXPECT_LT(with, without / 2);
}

std::multiset<std::array<Index, 4>> sorted_tets(const TetMesh& mesh) {
  std::multiset<std::array<Index, 4>> tets;
  for (auto tet : mesh.tets) {
    std::sort(tet.begin(), tet.end());
    tets.insert(tet);
  }
  return tets;
}

// If the exact geometry is too far away, replacing tets cannot help; tets must be marked as thin even after
// rounds that replaced none.
TEST(SecondOrder, TetsAreMarkedThinEvenWhereNoneCouldBeReplaced) {
  unsigned none_replaced = 0;
  for (const double factor : {0.95, 0.9, 0.8, 0.6}) {
    const Meshed meshed = coarsened(cylinder(1, 0.08, 120, 2), 0.7);
    TetMesh mesh = meshed.result.mesh;
    ASSERT_GT(std::count(mesh.tet_thin.begin(), mesh.tet_thin.end(), 1), 0);
    SecondOrderOptions options;
    options.bounds.distance = 0.01;
    options.bounds.thin_angle = 30;  // hardly any replacement has such angles
    options.exact = [&](unsigned dimension, Index, const Point& p) -> std::optional<Point> {
      if (dimension == 1) return std::nullopt;
      return Point{factor * p.x, factor * p.y, p.z};
    };
    const SecondOrderReport report = make_second_order(mesh, meshed.plc, options);
    if (!report.straightened.empty() && sorted_tets(mesh) == sorted_tets(meshed.result.mesh)) ++none_replaced;
    for (Index t = 0; t < mesh.tets.size(); ++t) {
      const auto& v = mesh.tets[t];
      const auto sphere = remeshing::circumsphere(
          {mesh.points[v[0]], mesh.points[v[1]], mesh.points[v[2]], mesh.points[v[3]]});
      EXPECT_EQ(mesh.tet_thin[t] != 0, sphere.squared_radius > 4 * sphere.shortest_squared_edge) << t;
    }
  }
  EXPECT_GT(none_replaced, 0U);
}

TEST(SecondOrder, CancelledAtAnyTimeItIsOfFirstOrder) {
  const Meshed meshed = coarsened(cylinder(1, 0.3, 120, 4), 0.7);
  TetMesh mesh = meshed.result.mesh;
  std::atomic<bool> cancel{false};
  SecondOrderOptions options{.bounds = without_thin()};
  options.exact = [&](unsigned, Index, const Point&) -> std::optional<Point> {
    cancel = true;
    return std::nullopt;
  };
  EXPECT_TRUE(make_second_order(mesh, meshed.plc, options, {.progress = {}, .cancel = &cancel}).cancelled);
  EXPECT_EQ(mesh.order(), 1);
  EXPECT_EQ(mesh.points, meshed.result.mesh.points);
}

// In a mesh that misses a guarantee, a curve may have an edge, and a patch a face, that no tet has.
TEST(SecondOrder, WhatIsInNoTetHasNodesOfItsOwn) {
  Meshed meshed = mesh_of(box(), with_size(0.5));
  TetMesh& mesh = meshed.result.mesh;
  const std::array<Index, 3> lost{vertex_at(mesh, {0, 0, 0}), vertex_at(mesh, {1, 1, 1}),
                                  vertex_at(mesh, {0, 1, 1})};
  mesh.edges.push_back({lost[0], lost[1]});
  mesh.edge_curve.push_back(mesh.edge_curve[0]);
  mesh.edge_tag.push_back(mesh.edge_tag[0]);
  mesh.faces.push_back(lost);
  mesh.face_patch.push_back(mesh.face_patch[0]);
  mesh.face_tag.push_back(mesh.face_tag[0]);
  mesh.face_regions.push_back(mesh.face_regions[0]);
  make_second_order(mesh, meshed.plc, {.bounds = without_thin()});
  ASSERT_EQ(mesh.edge_mid_nodes.size(), mesh.edges.size());
  EXPECT_EQ(mesh.edge_mid_nodes.back(), mesh.face_mid_nodes.back()[0]);
  for (std::size_t k = 0; k < 3; ++k) {
    const Index node = mesh.face_mid_nodes.back()[k];
    ASSERT_LT(node, mesh.points.size());
    EXPECT_EQ(mesh.points[node], 0.5 * (mesh.points[lost[k]] + mesh.points[lost[(k + 1) % 3]]));
  }
  EXPECT_NE(second_order_faults(meshed, mesh), "");
}

// A mesh as other programs write it: without features, with its own tags, without triangles and edges.
TEST(SecondOrder, IsJudgedByPosition) {
  const Meshed meshed = improved(cylinder(1, 1, 60, 3), 0.4, 0.05);
  TetMesh mesh = meshed.result.mesh;
  make_second_order(mesh, meshed.plc, {.bounds = without_thin()});
  mesh.features.clear();
  for (Tag& tag : mesh.face_tag) tag += 500;
  for (Tag& tag : mesh.edge_tag) tag += 500;
  EXPECT_EQ(second_order_faults(meshed, mesh, 0.05), "");
  mesh.faces.clear(), mesh.face_mid_nodes.clear(), mesh.face_regions.clear();
  mesh.face_patch.clear(), mesh.face_tag.clear();
  mesh.edges.clear(), mesh.edge_mid_nodes.clear(), mesh.edge_curve.clear(), mesh.edge_tag.clear();
  EXPECT_EQ(second_order_faults(meshed, mesh, 0.05), "");
}

TEST(SecondOrder, SameBytesAgain) {
  const Meshed meshed = improved(cylinder(1, 1, 60, 3), 0.4, 0.05);
  TetMesh first = meshed.result.mesh, second = meshed.result.mesh;
  make_second_order(first, meshed.plc, {.bounds = without_thin()});
  make_second_order(second, meshed.plc, {.bounds = without_thin()});
  EXPECT_EQ(first.points, second.points);
  EXPECT_EQ(first.tet_mid_nodes, second.tet_mid_nodes);
}

TEST(SecondOrder, RefusesAnImpossibleBound) {
  TetMesh mesh;
  for (const double impossible : {1.0, -0.1, std::nan("")})
    EXPECT_THROW(make_second_order(mesh, {}, {.exact = {}, .least_jacobian = impossible}), OptionError);
}

class WrongSecondOrder : public ::testing::Test {
 protected:
  void SetUp() override {
    meshed_ = improved(cylinder(1, 1, 60, 3), 0.4, 0.05);
    mesh_ = meshed_.result.mesh;
    make_second_order(mesh_, meshed_.plc, {.bounds = without_thin()});
    ASSERT_EQ(second_order_faults(meshed_, mesh_, 0.05), "");
  }
  void expect_finding(const std::string& guarantee) {
    EXPECT_NE(second_order_faults(meshed_, mesh_, 0.05).find(guarantee + ": "), std::string::npos)
        << second_order_faults(meshed_, mesh_, 0.05);
  }
  Meshed meshed_;
  TetMesh mesh_;
};

TEST_F(WrongSecondOrder, NodesNotShared) {
  mesh_.points.push_back(mesh_.points[mesh_.tet_mid_nodes[3][2]] + Vector{1e-3, 0, 0});
  mesh_.features.push_back(mesh_.features[mesh_.tet_mid_nodes[3][2]]);
  mesh_.tet_mid_nodes[3][2] = static_cast<Index>(mesh_.points.size() - 1);
  expect_finding("mid_nodes");
}
TEST_F(WrongSecondOrder, NodesInTheWrongOrder) {
  std::swap(mesh_.tet_mid_nodes[5][1], mesh_.tet_mid_nodes[5][3]);
  expect_finding("mid_nodes");
  expect_finding("positive_jacobian");
}
TEST_F(WrongSecondOrder, FacesWithOtherNodes) {
  std::swap(mesh_.face_mid_nodes[5][0], mesh_.face_mid_nodes[5][1]);
  expect_finding("mid_nodes");
}
TEST_F(WrongSecondOrder, ACornerAmidAnEdge) {
  mesh_.tet_mid_nodes[0][0] = mesh_.tets[0][2];
  expect_finding("mid_nodes");
}
TEST_F(WrongSecondOrder, Inverted) {
  const auto [a, b, c, d] = mesh_.tets[7];
  mesh_.points[mesh_.tet_mid_nodes[7][0]] = 0.9 * mesh_.points[a] + 0.1 * mesh_.points[b];
  expect_finding("positive_jacobian");
}
TEST_F(WrongSecondOrder, OffTheSurface) {
  for (Index f = 0; f < mesh_.faces.size(); ++f)
    if (!meshed_.plc.patches[mesh_.face_patch[f]].planar) {
      Point& p = mesh_.points[mesh_.face_mid_nodes[f][0]];
      p = p + 0.08 * Vector{p.x, p.y, 0};
      break;
    }
  expect_finding("mid_node_distance");
}
TEST_F(WrongSecondOrder, OffTheCurve) {
  Point& p = mesh_.points[mesh_.edge_mid_nodes[0]];
  p = p + Vector{0, 0, 0.07};
  expect_finding("mid_node_distance");
}
TEST_F(WrongSecondOrder, NodesOutOfRange) {
  mesh_.edge_mid_nodes[0] = static_cast<Index>(mesh_.points.size());
  expect_finding("valid_arrays");
}

}  // namespace
}  // namespace collarmesh::second_order_test
