#include "remesh/polyhedron_filling.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "collarmesh/geometry.h"

namespace collarmesh::remeshing::polyhedron_filling_test {
namespace {

using Triangle = std::array<Index, 3>;
using Tet = std::array<Index, 4>;
constexpr std::size_t most_steps = 100'000;

// A polyhedron whose fillings are judged by six times the volume of tets.
struct Polyhedron {
  std::vector<Point> points;
  std::vector<Triangle> hull;  // the positive side of each triangle is inside

  double volume_of(const Tet& t) const {
    return dot(cross(points[t[1]] - points[t[0]], points[t[2]] - points[t[0]]), points[t[3]] - points[t[0]]) /
           6;
  }
  double volume() const {
    double sum = 0;
    for (const auto& [a, b, c] : hull) sum -= dot(points[a], cross(points[b], points[c])) / 6;
    return sum;
  }
  std::vector<Tet> filled(double above = 0) const {
    return fill_polyhedron(
        hull, above, [this](const Tet& t, double) { return 6 * volume_of(t); }, most_steps);
  }
};

// A triangular prism with a twisted upper triangle. Diagonals go from each lower corner to the next upper
// one, or to the one before.
Polyhedron prism(double turn, bool forwards) {
  Polyhedron made;
  for (const double z : {0., 1.})
    for (unsigned i = 0; i < 3; ++i) {
      const double angle = 2 * std::numbers::pi * i / 3 + (z > 0 ? turn : 0);
      made.points.push_back({std::cos(angle), std::sin(angle), z});
    }
  made.hull = {{0, 1, 2}, {3, 5, 4}};
  for (Index i = 0; i < 3; ++i) {
    const Index j = (i + 1) % 3;
    if (forwards) {
      made.hull.push_back({i, j + 3, j});
      made.hull.push_back({i, i + 3, j + 3});
    } else {
      made.hull.push_back({i, i + 3, j});
      made.hull.push_back({j, i + 3, j + 3});
    }
  }
  return made;
}

TEST(PolyhedronFilling, FillsAPrismWhoseDiagonalsLetIt) {
  Polyhedron straight = prism(0, true);
  straight.hull[2] = {0, 3, 1};  // reverses this diagonal
  straight.hull[3] = {1, 3, 4};
  const auto tets = straight.filled();
  ASSERT_EQ(tets.size(), 3U);
  double sum = 0;
  for (const Tet& t : tets) {
    EXPECT_GT(straight.volume_of(t), 0);
    sum += straight.volume_of(t);
  }
  EXPECT_NEAR(sum, straight.volume(), 1e-12);
}

// With diagonals that go around, as in Schoenhardt's polyhedron, tets cannot fill it without another vertex.
TEST(PolyhedronFilling, FindsNothingWhereThereIsNothing) {
  for (const bool forwards : {false, true}) EXPECT_TRUE(prism(0, forwards).filled().empty());
}

// The octahedron has three fillings, one for each diagonal; the shortest diagonal gives the best filling.
TEST(PolyhedronFilling, TakesTheBest) {
  Polyhedron octahedron{{{-1, 0, 0}, {1, 0, 0}, {0, -2, 0}, {0, 2, 0}, {0, 0, -3}, {0, 0, 3}}, {}};
  for (const Index x : {0U, 1U})
    for (const Index y : {2U, 3U})
      for (const Index z : {4U, 5U}) {
        const bool turned = (x + y + z) % 2 == 0;
        octahedron.hull.push_back(turned ? Triangle{x, y, z} : Triangle{x, z, y});
      }
  ASSERT_NEAR(octahedron.volume(), 8, 1e-12);
  const auto longest = [&](const Tet& t) {
    double most = 0;
    for (unsigned i = 0; i < 4; ++i)
      for (unsigned j = 0; j < i; ++j)
        most = std::max(most, squared_distance(octahedron.points[t[i]], octahedron.points[t[j]]));
    return most;
  };
  const auto tets = fill_polyhedron(
      octahedron.hull, -100,
      [&](const Tet& t, double) { return octahedron.volume_of(t) > 0 ? -longest(t) : -1000; }, most_steps);
  ASSERT_EQ(tets.size(), 4U);
  for (const Tet& t : tets) EXPECT_LE(longest(t), 13 + 1e-12);
}

TEST(PolyhedronFilling, EndsAfterItsSteps) {
  const Polyhedron straight = prism(0.1, true);
  std::size_t steps = 0;
  EXPECT_TRUE(fill_polyhedron(
                  straight.hull, 0, [&](const Tet&, double) { return ++steps, 1.0; }, 5)
                  .size() < 10);
  EXPECT_LE(steps, 5U);
}

}  // namespace
}  // namespace collarmesh::remeshing::polyhedron_filling_test
