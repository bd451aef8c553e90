// The triangulation of a polygon whose worst triangle is best, compared with all triangulations.
#include "shells/best_triangles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "shells/triangle_shape.h"

namespace collarmesh::shells::best_triangles_test {
namespace {

using Polygon = std::vector<Point>;
using MayJoin = std::function<bool(unsigned, unsigned)>;

/// Returns the shape of the worst triangle in the best triangulation of the polygon's part between two
/// corners, by trying all triangulations.
double best_shape(const Polygon& polygon, const MayJoin& may_join, unsigned first, unsigned last) {
  if (last - first < 2) return INFINITY;
  const bool whole = first == 0 && last + 1 == polygon.size();
  if (!whole && !may_join(first, last)) return -1;
  double best = -1;
  for (unsigned apex = first + 1; apex < last; ++apex)
    best = std::max(best, std::min({shape_of({polygon[first], polygon[apex], polygon[last]}),
                                    best_shape(polygon, may_join, first, apex),
                                    best_shape(polygon, may_join, apex, last)}));
  return best;
}

Polygon random_polygon(std::mt19937_64& random, unsigned corners) {
  std::uniform_real_distribution<double> unit(0.2, 1);
  Polygon polygon;
  for (unsigned i = 0; i < corners; ++i) {
    const double angle = 2 * std::numbers::pi * i / corners, radius = unit(random);
    polygon.push_back({radius * std::cos(angle), radius * std::sin(angle), 0.1 * unit(random)});
  }
  return polygon;
}

TEST(BestTriangles, HaveTheLargestLeastShape) {
  constexpr unsigned polygons = 200;
  std::mt19937_64 random(5);
  for (unsigned i = 0; i < polygons; ++i) {
    const unsigned corners = 3 + i % 6;
    const Polygon polygon = random_polygon(random, corners);
    const MayJoin may_join = [&](unsigned a, unsigned b) { return (a + b + i) % 4 != 0; };
    const double best = best_shape(polygon, may_join, 0, corners - 1);
    const auto triangles = best_triangles(polygon, 0, may_join);
    ASSERT_EQ(triangles.has_value(), best >= 0);
    if (!triangles) continue;
    ASSERT_EQ(triangles->size(), corners - 2);
    double least = INFINITY;
    Vector area{}, whole{};
    for (const auto& [a, b, c] : *triangles) {
      ASSERT_LT(a, b);
      ASSERT_LT(b, c);
      least = std::min(least, shape_of({polygon[a], polygon[b], polygon[c]}));
      area = area + area_vector({polygon[a], polygon[b], polygon[c]});
    }
    for (unsigned a = 1; a + 1 < corners; ++a)
      whole = whole + area_vector({polygon[0], polygon[a], polygon[a + 1]});
    EXPECT_EQ(least, best);
    EXPECT_NEAR(distance(Point{} + area, Point{} + whole), 0, 1e-12);
    EXPECT_FALSE(best_triangles(polygon, 1.001 * best, may_join));
  }
}

TEST(BestTriangles, TwoCornersNeedNone) {
  const Polygon two{{0, 0, 0}, {1, 0, 0}};
  const auto triangles = best_triangles(two, 20, [](unsigned, unsigned) { return true; });
  ASSERT_TRUE(triangles);
  EXPECT_TRUE(triangles->empty());
}

}  // namespace
}  // namespace collarmesh::shells::best_triangles_test
