// Volumes, areas and lengths of curved elements, compared with other formulas.
#include "collarmesh/shape_measures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "collarmesh/plc_builder.h"
#include "collarmesh/tet_mesh.h"
#include "support/shapes.h"

namespace collarmesh::shape_measures_test {
namespace {

constexpr std::array<std::array<std::size_t, 2>, 6> ends{{{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}};

CurvedTet straight_tet(const Point& a, const Point& b, const Point& c, const Point& d) {
  CurvedTet nodes{a, b, c, d};
  for (std::size_t e = 0; e < 6; ++e) nodes[4 + e] = 0.5 * (nodes[ends[e][0]] + nodes[ends[e][1]]);
  return nodes;
}

/// Returns the image of barycentric coordinates under the quadratic map.
Point image(const CurvedTet& nodes, const std::array<double, 4>& l) {
  Vector sum{};
  for (std::size_t i = 0; i < 4; ++i) sum = sum + l[i] * (2 * l[i] - 1) * (nodes[i] - Point{});
  for (std::size_t e = 0; e < 6; ++e)
    sum = sum + 4 * l[ends[e][0]] * l[ends[e][1]] * (nodes[4 + e] - Point{});
  return Point{} + sum;
}

/// Returns the volume under the surface of a curved face, by n by n small triangles.
double cones_under_face(const CurvedTet& nodes, const std::array<unsigned, 3>& corners, unsigned n) {
  double sum = 0;
  const auto at = [&](double i, double j) {
    std::array<double, 4> l{};
    l[corners[0]] = 1 - (i + j) / n;
    l[corners[1]] = i / n;
    l[corners[2]] = j / n;
    return image(nodes, l) - Point{};
  };
  for (unsigned i = 0; i < n; ++i)
    for (unsigned j = 0; i + j < n; ++j) {
      sum += dot(at(i, j), cross(at(i + 1, j), at(i, j + 1))) / 6;
      if (i + j + 1 < n) sum += dot(at(i + 1, j), cross(at(i + 1, j + 1), at(i, j + 1))) / 6;
    }
  return sum;
}

/// Extrapolates, because errors are proportional to the square of the steps.
double volume_by_faces(const CurvedTet& nodes) {
  constexpr std::array<std::array<unsigned, 3>, 4> faces{{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
  double coarse = 0, fine = 0;
  for (const auto& face : faces) {
    coarse += cones_under_face(nodes, face, 16);
    fine += cones_under_face(nodes, face, 32);
  }
  return (4 * fine - coarse) / 3;
}

TEST(ShapeMeasures, AStraightTetHasItsVolume) {
  const CurvedTet nodes = straight_tet({1000, 0, 0}, {1001, 0.5, 0}, {1000, 2, 0.25}, {1000.5, 0.5, 1});
  EXPECT_NEAR(volume(nodes), measure(nodes[0], nodes[1], nodes[2], nodes[3]).volume, 1e-12);
}

TEST(ShapeMeasures, ACurvedTetHasWhatItsFacesEnclose) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> off(-0.1, 0.1);
  for (int round = 0; round < 20; ++round) {
    CurvedTet nodes = straight_tet({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1});
    for (std::size_t i = 4; i < 10; ++i) nodes[i] = nodes[i] + Vector{off(random), off(random), off(random)};
    EXPECT_NEAR(volume(nodes), volume_by_faces(nodes), 1e-6);
  }
}

TEST(ShapeMeasures, VolumesBelowTheFacesOfACurvedTetAddUpToItsOwn) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> off(-0.1, 0.1);
  for (int round = 0; round < 20; ++round) {
    CurvedTet nodes = straight_tet({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1});
    for (std::size_t i = 4; i < 10; ++i) nodes[i] = nodes[i] + Vector{off(random), off(random), off(random)};
    const auto& [a, b, c, d, ab, bc, ca, ad, bd, cd] = nodes;
    double sum = 0;
    for (const CurvedTriangle& face :
         {CurvedTriangle{a, c, b, ca, bc, ab}, CurvedTriangle{a, b, d, ab, bd, ad},
          CurvedTriangle{b, c, d, bc, cd, bd}, CurvedTriangle{c, a, d, ca, ad, cd}})
      sum += volume_below({3, 2, -1}, face);
    EXPECT_NEAR(sum, volume(nodes), 1e-12);
  }
}

/// A box with a void, another box on top, and one that stands alone.
TEST(ShapeMeasures, ShellsAreWhatBoundsMoreOrLessThanARegion) {
  using testing::box;
  const PolygonSoup with_void =
      testing::joined(box({0, 0, 0}, {4, 4, 4}), testing::inverted(box({1, 1, 1}, {2, 3, 3})));
  const std::vector<PolygonSoup> soups{with_void, box({0, 0, 4}, {4, 4, 5}), box({9, 0, 0}, {10, 1, 1})};
  const Plc plc = build_plc(soups);
  const ShapeMeasures measures = measures_of(plc);
  ASSERT_EQ(measures.shells.size(), shells_of(plc).size());
  std::vector<double> enclosed = measures.shells;
  std::sort(enclosed.begin(), enclosed.end());
  ASSERT_EQ(enclosed.size(), 3U);  // the void, the lower box with it, both boxes
  EXPECT_NEAR(enclosed[0], 4, 1e-12);
  EXPECT_NEAR(enclosed[1], 64, 1e-12);
  EXPECT_NEAR(enclosed[2], 80, 1e-12);
}

TEST(ShapeMeasures, ACurvedTriangleInAPlaneGainsParabolas) {
  CurvedTriangle nodes{Point{0, 0, 5}, {4, 0, 5}, {0, 3, 5}, {2, 0, 5}, {2, 1.5, 5}, {0, 1.5, 5}};
  EXPECT_NEAR(area(nodes), 6, 1e-12);
  nodes[3].y = -0.25;  // area: two thirds of chord times height
  EXPECT_NEAR(area(nodes), 6 + 2. / 3 * 4 * 0.25, 1e-12);
}

TEST(ShapeMeasures, ACurvedEdgeIsAsLongAsItsParabola) {
  EXPECT_NEAR(length(CurvedEdge{Point{0, 0, 0}, {3, 0, 4}, {1.5, 0, 2}}), 5, 1e-14);
  const double height = 0.1, slope = 4 * height;  // the parabola y = slope x (1 - x)
  const double exact = 0.5 * std::sqrt(1 + slope * slope) + std::asinh(slope) / (2 * slope);
  EXPECT_NEAR(length(CurvedEdge{Point{0, 0, 0}, {1, 0, 0}, {0.5, height, 0}}), exact, 1e-5);
}

}  // namespace
}  // namespace collarmesh::shape_measures_test
