// The Jacobian's coefficients compared with the shape functions, and nodes that make room for curved edges.
#include "second_order/untangling.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>

#include "collarmesh/curved_tet.h"
#include "second_order/jacobian_coefficients.h"
#include "support/meshing.h"
#include "support/shapes.h"

namespace collarmesh::untangling_test {
namespace {

using namespace collarmesh::testing;
using second_order::JacobianCoefficients;
using second_order::MeshEdges;
using second_order::Untangling;

constexpr std::array<std::array<std::size_t, 2>, 6> ends{{{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}};

CurvedTet random_tet(std::mt19937& random, double curvature) {
  std::uniform_real_distribution<double> around(-1, 1);
  const auto vector = [&] { return Vector{around(random), around(random), around(random)}; };
  CurvedTet nodes;
  do {
    for (std::size_t k = 0; k < 4; ++k) nodes[k] = vector();
  } while (six_volume(nodes[0], nodes[1], nodes[2], nodes[3]) < 0.1);
  for (std::size_t e = 0; e < 6; ++e)
    nodes[4 + e] = 0.5 * (nodes[ends[e][0]] + nodes[ends[e][1]]) + curvature * vector();
  return nodes;
}

/// Returns the determinant by the derivatives of the shape functions at barycentric coordinates.
double determinant(const CurvedTet& nodes, const std::array<double, 4>& l) {
  std::array<Vector, 4> d;
  for (std::size_t i = 0; i < 4; ++i) d[i] = (4 * l[i] - 1) * nodes[i];
  for (std::size_t e = 0; e < 6; ++e) {
    d[ends[e][0]] = d[ends[e][0]] + 4 * l[ends[e][1]] * nodes[4 + e];
    d[ends[e][1]] = d[ends[e][1]] + 4 * l[ends[e][0]] * nodes[4 + e];
  }
  return dot(cross(d[1] - d[0], d[2] - d[0]), d[3] - d[0]);
}

/// Returns the value of the cubic with these Bernstein coefficients, in the order of i <= j <= k.
double cubic(const JacobianCoefficients::Values& values, const std::array<double, 4>& l) {
  double sum = 0;
  std::size_t c = 0;
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = i; j < 4; ++j)
      for (std::size_t k = j; k < 4; ++k, ++c) {
        const double ways = i == j && j == k ? 1 : i == j || j == k ? 3 : 6;
        sum += ways * values[c] * l[i] * l[j] * l[k];
      }
  return sum;
}

TEST(JacobianCoefficients, AreThoseOfTheDeterminant) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> share(0, 1);
  for (int tet = 0; tet < 50; ++tet) {
    const CurvedTet nodes = random_tet(random, 0.2);
    const JacobianCoefficients coefficients(nodes);
    for (int point = 0; point < 10; ++point) {
      std::array<double, 4> l{share(random), share(random), share(random), share(random)};
      const double sum = l[0] + l[1] + l[2] + l[3];
      for (double& x : l) x /= sum;
      EXPECT_NEAR(cubic(coefficients.values(), l), determinant(nodes, l), 1e-12);
      EXPECT_GE(determinant(nodes, l), coefficients.least() - 1e-12);
    }
  }
}

TEST(JacobianCoefficients, AreSixTimesTheVolumeOfAStraightTet) {
  std::mt19937 random(2);
  const CurvedTet nodes = random_tet(random, 0);
  const double volume = six_volume(nodes[0], nodes[1], nodes[2], nodes[3]);
  const JacobianCoefficients coefficients(nodes);
  for (const double value : coefficients.values()) EXPECT_NEAR(value, volume, 1e-14);
}

TEST(JacobianCoefficients, TheirGradientIsThatOfDifferences) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> around(-1, 1);
  for (int tet = 0; tet < 20; ++tet) {
    CurvedTet nodes = random_tet(random, 0.2);
    JacobianCoefficients::Values weights;
    for (double& weight : weights) weight = around(random);
    const auto weighted = [&] {
      const JacobianCoefficients coefficients(nodes);
      double sum = 0;
      for (std::size_t c = 0; c < JacobianCoefficients::count; ++c)
        sum += weights[c] * coefficients.values()[c];
      return sum;
    };
    const std::array<Vector, 6> gradient = JacobianCoefficients(nodes).gradient(weights);
    constexpr double step = 1e-5;
    for (std::size_t e = 0; e < 6; ++e)
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double at = nodes[4 + e][axis];
        nodes[4 + e][axis] = at + step;
        const double above = weighted();
        nodes[4 + e][axis] = at - step;
        const double below = weighted();
        nodes[4 + e][axis] = at;
        EXPECT_NEAR(gradient[e][axis], (above - below) / (2 * step), 1e-7);
      }
  }
}

bool valid(const TetMesh& mesh, Index tet) { return jacobian_exceeds(curved_tet(mesh, tet), 0.1); }

// An edge in a box bulges sideways by a fifth of its length; the nodes of tets at it follow until all tets
// are valid.
TEST(Untangling, NodesFollowAnEdgeThatBulges) {
  Meshed meshed = mesh_of(box(), with_size(0.4));
  TetMesh& mesh = meshed.result.mesh;
  const MeshEdges edges(mesh);
  add_mid_nodes(edges, mesh);
  const std::vector<Point> middles = mesh.points;
  std::size_t made = 0, impossible = 0;
  for (Index edge = 0; edge < edges.size(); ++edge) {
    if (edges.feature(edge).dimension != 3) continue;
    mesh.points = middles;
    const auto [a, b] = edges.ends(edge);
    const Vector along = mesh.points[b] - mesh.points[a], aside = cross(along, Vector{0.3, -0.5, 0.8});
    Point& node = mesh.points[edges.first_node() + edge];
    node = node + 0.2 * norm(along) / norm(aside) * aside;
    const Point kept = node;
    Untangling untangling(mesh, edges, meshed.plc, 0.1);
    untangling.keep(edge);
    for (const Index tet : untangling.tets_at(edge)) {
      if (valid(mesh, tet)) continue;
      std::vector<Index> before;
      for (Index t = 0; t < mesh.tets.size(); ++t)
        if (valid(mesh, t)) before.push_back(t);
      const std::vector<Point> places = mesh.points;
      if (untangling.untangle(tet) > 0) {
        ++made;
        EXPECT_TRUE(valid(mesh, tet));
        for (const Index t : before) EXPECT_TRUE(valid(mesh, t));
      } else {
        ++impossible;
        EXPECT_EQ(mesh.points, places);
      }
      EXPECT_EQ(node, kept);
    }
    for (Index other = 0; other < edges.size(); ++other) {
      const Point &now = mesh.points[edges.first_node() + other], &was = middles[edges.first_node() + other];
      const TetMesh::VertexFeature& feature = edges.feature(other);
      if (feature.dimension == 2) {
        EXPECT_NEAR(dot(now - was, meshed.plc.patches[feature.feature].normal), 0, 1e-12);
      }
      if (feature.dimension == 1) {
        EXPECT_EQ(now, was);
      }
    }
  }
  EXPECT_GT(made, 20U);
  EXPECT_LT(impossible, made / 2);
}

}  // namespace
}  // namespace collarmesh::untangling_test
