// The sign of the Jacobian over a whole tetrahedron of second order, compared with dense sampling.
#include "collarmesh/curved_tet.h"
#include "support/sanitized.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace collarmesh::curved_tet_test {
namespace {

constexpr std::array<std::array<std::size_t, 2>, 6> ends{{{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}};

CurvedTet straight(const Point& a, const Point& b, const Point& c, const Point& d) {
  CurvedTet nodes{a, b, c, d};
  for (std::size_t e = 0; e < 6; ++e) nodes[4 + e] = 0.5 * (nodes[ends[e][0]] + nodes[ends[e][1]]);
  return nodes;
}

CurvedTet unit_tet() { return straight({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}); }

// Returns the Jacobian by the derivatives of the shape functions: l (2 l - 1) at corners, 4 l l' at mid-edge
// nodes.
double jacobian_at(const CurvedTet& nodes, const std::array<double, 4>& l) {
  std::array<Vector, 4> derivative;  // by each barycentric coordinate
  for (std::size_t i = 0; i < 4; ++i) derivative[i] = (4 * l[i] - 1) * nodes[i];
  for (std::size_t e = 0; e < 6; ++e) {
    const auto [i, j] = ends[e];
    derivative[i] = derivative[i] + 4 * l[j] * nodes[4 + e];
    derivative[j] = derivative[j] + 4 * l[i] * nodes[4 + e];
  }
  return dot(cross(derivative[1] - derivative[0], derivative[2] - derivative[0]),
             derivative[3] - derivative[0]);
}

double least_sample(const CurvedTet& nodes, int n) {
  double least = INFINITY;
  for (int i = 0; i <= n; ++i)
    for (int j = 0; i + j <= n; ++j)
      for (int k = 0; i + j + k <= n; ++k)
        least = std::min(least, jacobian_at(nodes, {(n - i - j - k) / double(n), i / double(n), j / double(n),
                                                    k / double(n)}));
  return least;
}

TEST(CurvedTet, StraightTetsAreJudgedByTheirCorners) {
  EXPECT_TRUE(jacobian_exceeds(unit_tet()));
  EXPECT_TRUE(jacobian_exceeds(unit_tet(), 0.99));
  EXPECT_FALSE(jacobian_exceeds(straight({0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {0, 0, 1})));
  EXPECT_FALSE(jacobian_exceeds(straight({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0})));
  EXPECT_TRUE(jacobian_exceeds(straight({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.3, 0.3, 1e-15})));
}

TEST(CurvedTet, AMidNodeBeyondTheQuarterOfItsEdgeInverts) {
  // Along the edge the map is t -> 4 m t (1 - t) + t (2 t - 1). Its derivative at the corner, 4 m - 1,
  // vanishes at m = 1/4.
  CurvedTet nodes = unit_tet();
  nodes[4] = {0.2501, 0, 0};
  EXPECT_TRUE(jacobian_exceeds(nodes));
  nodes[4] = {0.2499, 0, 0};
  EXPECT_FALSE(jacobian_exceeds(nodes));
}

// The determinant is negative only in the middle of an edge, which its values at corners do not show.
TEST(CurvedTet, FindsAnInversionBetweenTheCorners) {
  CurvedTet nodes = unit_tet();
  nodes[5] = {0.5, 0, 0.05};  // along ab the directions to c and d make one full turn together
  nodes[8] = {0.5, 0.05, 0};
  for (std::size_t i = 0; i < 4; ++i) {
    std::array<double, 4> corner{};
    corner[i] = 1;
    ASSERT_GT(jacobian_at(nodes, corner), 0.5);
  }
  ASSERT_LT(least_sample(nodes, 24), 0);
  EXPECT_FALSE(jacobian_exceeds(nodes));
}

TEST(CurvedTet, AgreesWithSamples) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> offset(-1, 1);
  int valid = 0, invalid = 0, decided_inside = 0;
  constexpr int trials = testing::sanitized ? 400 : 4000;
  for (int trial = 0; trial < trials; ++trial) {
    const double reach = 0.02 + 0.2 * (trial % 10) / 10;
    const auto moved = [&](const Point& p, double by) {
      return p + by * Vector{offset(random), offset(random), offset(random)};
    };
    CurvedTet nodes =
        straight(moved({0, 0, 0}, 0.1), moved({1, 0, 0}, 0.1), moved({0, 1, 0}, 0.1), moved({0, 0, 1}, 0.1));
    const double straight_one = jacobian_at(nodes, {0.25, 0.25, 0.25, 0.25});
    for (std::size_t e = 4; e < 10; ++e) nodes[e] = moved(nodes[e], reach);
    for (const double least : {0.0, 0.2}) {
      const double bound = least * straight_one, sample = least_sample(nodes, 20);
      if (jacobian_exceeds(nodes, least)) {
        ++valid;
        EXPECT_GT(sample, bound) << "trial " << trial;
      } else {
        ++invalid;
        // The determinant's second derivatives bound how far it can be below the samples.
        EXPECT_LT(sample, bound + 0.02 * straight_one) << "trial " << trial;
        const double at_corners =
            std::min({jacobian_at(nodes, {1, 0, 0, 0}), jacobian_at(nodes, {0, 1, 0, 0}),
                      jacobian_at(nodes, {0, 0, 1, 0}), jacobian_at(nodes, {0, 0, 0, 1})});
        if (at_corners > bound) ++decided_inside;
      }
    }
  }
  EXPECT_GT(valid, trials / 4);
  EXPECT_GT(invalid, trials / 4);
  EXPECT_GT(decided_inside, trials / 200);
}

TEST(CurvedTet, ScaleAndPlaceDoNotMatter) {
  for (const double scale : {1e-6, 1.0, 1e6})
    for (const double shift : {0.0, 1e3})
      for (const double m : {0.24, 0.26}) {
        CurvedTet nodes = unit_tet();
        nodes[4] = {m, 0, 0};
        for (Point& p : nodes) p = scale * (p + Vector{shift, -shift, shift});
        EXPECT_EQ(jacobian_exceeds(nodes), m > 0.25) << scale << ' ' << shift;
      }
}

}  // namespace
}  // namespace collarmesh::curved_tet_test
