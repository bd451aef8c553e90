// Jacobians of prisms and pyramids against samples of their maps.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "common/layer_jacobians.h"

namespace collarmesh::layer_jacobians_test {
namespace {

/// Returns random corners around those of the unit prism or pyramid.
template <std::size_t n>
std::array<Point, n> shaken(std::array<Point, n> p, double by, std::mt19937_64& random) {
  std::uniform_real_distribution<double> away(-by, by);
  for (Point& each : p) each = each + Vector{away(random), away(random), away(random)};
  return p;
}

constexpr PrismCorners unit_prism{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}}};
constexpr PyramidCorners unit_pyramid{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.5, 1}}};

Point place(const PrismCorners& p, double x, double y, double z) {
  const auto at = [&](unsigned from) { return (1 - x - y) * p[from] + x * p[from + 1] + y * p[from + 2]; };
  return (1 - z) * at(0) + z * at(3);
}

Point place(const PyramidCorners& p, double x, double y, double z) {
  const Point base = (1 - x) * (1 - y) * p[0] + x * (1 - y) * p[1] + x * y * p[2] + (1 - x) * y * p[3];
  return (1 - z) * base + z * p[4];
}

/// Returns the Jacobian of the map by finite differences.
template <class Corners>
double sampled(const Corners& p, double x, double y, double z) {
  constexpr double h = 1e-5;
  const auto slope = [&](double dx, double dy, double dz) {
    return (place(p, x + h * dx, y + h * dy, z + h * dz) - place(p, x - h * dx, y - h * dy, z - h * dz)) /
           (2 * h);
  };
  return dot(cross(slope(1, 0, 0), slope(0, 1, 0)), slope(0, 0, 1));
}

TEST(LayerJacobians, LeastOfPrismIsThatOfSamples) {
  std::mt19937_64 random(1);
  for (int k = 0; k < 200; ++k) {
    const PrismCorners p = shaken(unit_prism, 0.4, random);
    double least = INFINITY;
    constexpr int steps = 24;
    for (int i = 0; i <= steps; ++i)
      for (const auto& [x, y] : {std::array{0.0, 0.0}, {1.0, 0.0}, {0.0, 1.0}, {0.3, 0.3}})
        least = std::min(least, sampled(p, x, y, static_cast<double>(i) / steps));
    EXPECT_EQ(least_jacobian(p) > 0, least > 0) << k;
    EXPECT_LE(least_jacobian(p), least + 1e-6);
    if (least > 0.01) {
      EXPECT_NEAR(least_jacobian(p), least, 0.01);
    }
  }
}

TEST(LayerJacobians, LeastOfPyramidIsAtItsBase) {
  std::mt19937_64 random(2);
  for (int k = 0; k < 200; ++k) {
    const PyramidCorners p = shaken(unit_pyramid, 0.4, random);
    double least = INFINITY;
    constexpr int steps = 8;
    for (int i = 0; i <= steps; ++i)
      for (int j = 0; j <= steps; ++j)
        for (const double z : {0.0, 0.5, 0.9})
          least =
              std::min(least, sampled(p, static_cast<double>(i) / steps, static_cast<double>(j) / steps, z) /
                                  ((1 - z) * (1 - z)));
    EXPECT_NEAR(least_jacobian(p), least, 1e-6) << k;
  }
}

TEST(LayerJacobians, VolumesAreIntegrals) {
  std::mt19937_64 random(3);
  constexpr int steps = 40;
  const PrismCorners prism = shaken(unit_prism, 0.3, random);
  const PyramidCorners pyramid = shaken(unit_pyramid, 0.3, random);
  double of_prism = 0, of_pyramid = 0;
  const auto middle = [](int i) { return (i + 0.5) / steps; };
  for (int i = 0; i < steps; ++i)
    for (int j = 0; j < steps; ++j)
      for (int k = 0; k < steps; ++k) {
        // The square is folded onto the triangle.
        const double x = middle(i), y = (1 - x) * middle(j), z = middle(k),
                     cell = 1.0 / (steps * steps * steps);
        of_prism += cell * (1 - x) * sampled(prism, x, y, z);
        of_pyramid += cell * sampled(pyramid, x, middle(j), z);
      }
  EXPECT_NEAR(volume_of(prism), of_prism, 1e-3);
  EXPECT_NEAR(volume_of(pyramid), of_pyramid, 1e-3);
}

template <std::size_t edges, std::size_t n>
std::array<Point, edges> middles(const std::array<Point, n>& p,
                                 const std::array<std::array<unsigned, 2>, edges>& ends) {
  std::array<Point, edges> found;
  for (std::size_t e = 0; e < edges; ++e) found[e] = 0.5 * (p[ends[e][0]] + p[ends[e][1]]);
  return found;
}

constexpr std::array<std::array<unsigned, 2>, 9> edges_of_prism{
    {{0, 1}, {1, 2}, {2, 0}, {3, 4}, {4, 5}, {5, 3}, {0, 3}, {1, 4}, {2, 5}}};
constexpr std::array<std::array<unsigned, 2>, 8> edges_of_pyramid{
    {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {0, 4}, {1, 4}, {2, 4}, {3, 4}}};

TEST(LayerJacobians, StraightCellsOfSecondOrderAreLinearOnes) {
  std::mt19937_64 random(4);
  for (int k = 0; k < 100; ++k) {
    // The reference prism of second order is twice as high as the linear one, the reference pyramid twice as
    // long and wide.
    const PrismCorners prism = shaken(unit_prism, 0.2, random);
    double at_corners = INFINITY;
    for (unsigned i = 0; i < 3; ++i) {
      const auto along = jacobian_along_edge(prism, i);
      at_corners = std::min({at_corners, along[0], along[2]});
    }
    const double least = 2 * least_jacobian_at_points(prism, middles(prism, edges_of_prism));
    EXPECT_LE(least, at_corners + 1e-9);
    EXPECT_GE(least, least_jacobian(prism) - 1e-9);
    const PyramidCorners pyramid = shaken(unit_pyramid, 0.2, random);
    EXPECT_NEAR(4 * least_jacobian_at_points(pyramid, middles(pyramid, edges_of_pyramid)),
                least_jacobian(pyramid), 1e-9);
  }
}

TEST(LayerJacobians, BulgeAboveTheHeightFoldsAPrism) {
  PrismCorners flat = unit_prism;
  for (unsigned i = 3; i < 6; ++i) flat[i].z = 0.1;
  auto mid = middles(flat, edges_of_prism);
  EXPECT_GT(least_jacobian_at_points(flat, mid), 0);
  mid[0].z = 0.2;  // the edge below rises above the upper one
  EXPECT_LT(least_jacobian_at_points(flat, mid), 0);
}

}  // namespace
}  // namespace collarmesh::layer_jacobians_test
