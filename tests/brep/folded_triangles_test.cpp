// Triangles of a face that are folded onto each other.
#include "folded_triangles.h"

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <set>

namespace collarmesh::brep::folded_triangles_test {
namespace {

using Triangles = std::vector<std::array<Index, 3>>;

// The points of a grid of n x n squares, border points first, and its triangles.
struct Grid {
  std::vector<Point> points;
  Triangles triangles;
  Index first_inner = 0;

  explicit Grid(Index n) {
    std::vector<Index> at((n + 1) * (n + 1));
    for (const bool border : {true, false}) {
      if (!border) first_inner = static_cast<Index>(points.size());
      for (Index i = 0; i <= n; ++i)
        for (Index j = 0; j <= n; ++j) {
          if ((i == 0 || j == 0 || i == n || j == n) != border) continue;
          at[i * (n + 1) + j] = static_cast<Index>(points.size());
          points.push_back({static_cast<double>(i), static_cast<double>(j), 0});
        }
    }
    for (Index i = 0; i < n; ++i)
      for (Index j = 0; j < n; ++j) {
        const Index a = at[i * (n + 1) + j], b = at[(i + 1) * (n + 1) + j];
        const Index c = at[(i + 1) * (n + 1) + j + 1], d = at[i * (n + 1) + j + 1];
        triangles.insert(triangles.end(), {{a, b, c}, {a, c, d}});
      }
  }
};

double area(const std::vector<Point>& points, const Triangles& triangles) {
  double sum = 0;
  for (const auto& [a, b, c] : triangles) sum += 0.5 * cross(points[b] - points[a], points[c] - points[a]).z;
  return sum;
}

std::set<std::array<Index, 2>> border(const Triangles& triangles) {
  std::set<std::array<Index, 2>> sides;
  for (const auto& t : triangles)
    for (std::size_t i = 0; i < 3; ++i)
      if (sides.erase({t[(i + 1) % 3], t[i]}) == 0) sides.insert({t[i], t[(i + 1) % 3]});
  return sides;
}

/// Returns the number of edges at which triangles turn by more than 90 degrees.
std::size_t count_folds(const std::vector<Point>& points, const Triangles& triangles) {
  std::map<std::array<Index, 2>, Vector> normal_at;  // by directed side
  std::size_t folds = 0;
  for (const auto& [a, b, c] : triangles) {
    const Vector normal = cross(points[b] - points[a], points[c] - points[a]);
    for (const std::array<Index, 2>& side : {std::array{a, b}, std::array{b, c}, std::array{c, a}}) {
      const auto across = normal_at.find({side[1], side[0]});
      if (across != normal_at.end() && dot(across->second, normal) < 0) ++folds;
      normal_at[side] = normal;
    }
  }
  return folds;
}

TEST(FoldedTriangles, StayWhereThereAreNone) {
  const Grid grid(6);
  Triangles triangles = grid.triangles;
  EXPECT_EQ(count_folds(grid.points, triangles), 0U);
  unfold(grid.points, grid.first_inner, 0.1, triangles);
  EXPECT_EQ(triangles, grid.triangles);
}

// Inner points are moved across a side or two of their stars. Most folds go, and nothing else changes.
TEST(FoldedTriangles, AreCutAnew) {
  std::mt19937_64 random(3);
  unsigned folded = 0, left = 0;
  for (unsigned k = 0; k < 200; ++k) {
    Grid grid(6);
    std::uniform_int_distribution<Index> any(grid.first_inner, static_cast<Index>(grid.points.size() - 1));
    std::uniform_real_distribution<double> step(-1.4, 1.4);
    Point& moved = grid.points[any(random)];
    const double dx = step(random), dy = step(random);
    if (moved.x + dx < 0 || moved.x + dx > 6 || moved.y + dy < 0 || moved.y + dy > 6) continue;
    moved = moved + Vector{dx, dy, 1e-3};
    if (count_folds(grid.points, grid.triangles) == 0) continue;
    ++folded;
    Triangles triangles = grid.triangles;
    unfold(grid.points, grid.first_inner, 0.1, triangles);
    if (count_folds(grid.points, triangles) > 0) ++left;
    EXPECT_NEAR(area(grid.points, triangles), 36, 1e-9);
    EXPECT_EQ(border(triangles), border(grid.triangles));
  }
  EXPECT_GT(folded, 50U);
  EXPECT_LT(left, folded / 4);  // folds remain where no point may move far enough
}

// A needle at the border lies on the triangle beside it. No inner point can be merged, so a side is flipped.
TEST(FoldedTriangles, AtTheBorderAreFlipped) {
  const std::vector<Point> points{{0, 0, 0}, {10, 0, 0}, {10, 10, 0}, {5, 0.1, 1e-3}, {0, 10, 0}};
  // The border is 0 3 1 2 4; the side 0 1 cuts off 3, which lies on the other side of it.
  Triangles triangles{{0, 3, 1}, {0, 1, 2}, {0, 2, 4}};
  const auto before = border(triangles);
  ASSERT_EQ(count_folds(points, triangles), 1U);
  unfold(points, 5, 0.1, triangles);
  EXPECT_EQ(count_folds(points, triangles), 0U);
  EXPECT_EQ(border(triangles), before);
}

}  // namespace
}  // namespace collarmesh::brep::folded_triangles_test
