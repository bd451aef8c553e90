// The kernel compared with CGAL's triangulation and exact arithmetic.
#include "delaunay/triangulation.h"

#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <random>
#include <set>

#include "delaunay/predicates.h"

namespace collarmesh::delaunay_triangulation_test {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Oracle = CGAL::Delaunay_triangulation_3<Kernel>;

struct PointSet {
  std::string name;
  std::vector<Point> points;
};

void PrintTo(const PointSet& set, std::ostream* out) { *out << set.name; }

PointSet random_points(const std::string& name, std::size_t n, const Point& offset, double scale) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> unit(0, 1);
  PointSet set{name, {}};
  for (std::size_t i = 0; i < n; ++i)
    set.points.push_back(offset + scale * Point{unit(random), unit(random), unit(random)});
  return set;
}

PointSet grid(const std::string& name, int n, const Point& offset, double noise) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> unit(-1, 1);
  PointSet set{name, {}};
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      for (int k = 0; k < n; ++k)
        set.points.push_back(offset + Point{double(i), double(j), double(k)} +
                             noise * Point{unit(random), unit(random), unit(random)});
  std::shuffle(set.points.begin(), set.points.end(), random);
  return set;
}

PointSet on_sphere(std::size_t n) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  PointSet set{"on_sphere", {}};
  for (std::size_t i = 0; i < n; ++i) {
    const Point p{normal(random), normal(random), normal(random)};
    set.points.push_back(p / norm(p));
  }
  return set;
}

PointSet on_plane_and_line() {
  PointSet set{"on_plane_and_line", {}};
  for (int i = 0; i < 15; ++i)
    for (int j = 0; j < 15; ++j) set.points.push_back({i / 16.0, j / 16.0, 0.5});
  for (int i = 0; i < 40; ++i) set.points.push_back({0.25 + 1e-3 * i, 0.125, 0.75});
  return set;
}

class DelaunayTriangulation : public ::testing::TestWithParam<PointSet> {
 protected:
  static Box box_around(const std::vector<Point>& points) {
    Box tight;
    for (const Point& p : points) tight.add(p);
    const double reach = tight.diagonal();
    Box box;
    box.add(tight.min - reach * Vector{0.87, 0.89, 0.91});
    box.add(tight.max + reach * Vector{0.87, 0.89, 0.91});
    return box;
  }

  static Index conflicting_cell(Triangulation& mesh, const Point& p) {
    for (Index cell = 0; cell < mesh.cell_capacity(); ++cell)
      if (mesh.alive(cell) && mesh.in_conflict(cell, p)) return cell;
    return none;
  }

  static Index nearest(Triangulation& mesh, const Point& p) {
    Index at = mesh.vertex_count() - 1;
    std::vector<Index> around;
    for (;;) {
      Index next = at;
      mesh.adjacent_vertices(at, around);
      for (const Index v : around)
        if (squared_distance(p, mesh.point(v)) < squared_distance(p, mesh.point(next))) next = v;
      if (next == at) return at;
      at = next;
    }
  }

  static void insert_all(Triangulation& mesh, const std::vector<Point>& points) {
    ConflictZone zone;
    for (const Point& p : points) {
      const Index cell = mesh.conflicting_cell_around(nearest(mesh, p), p);
      ASSERT_NE(cell, none);
      mesh.find_conflict_zone(p, cell, zone);
      mesh.insert(zone);
    }
  }
};

TEST_P(DelaunayTriangulation, IsValidAndLocallyDelaunay) {
  Triangulation mesh(box_around(GetParam().points));
  insert_all(mesh, GetParam().points);
  ASSERT_EQ(mesh.vertex_count(), GetParam().points.size() + 8);
  Index alive = 0;
  for (Index cell = 0; cell < mesh.cell_capacity(); ++cell) {
    if (!mesh.alive(cell)) continue;
    ++alive;
    const auto& v = mesh.corners(cell);
    ASSERT_GT(
        predicates::orientation_exact(mesh.point(v[0]), mesh.point(v[1]), mesh.point(v[2]), mesh.point(v[3])),
        0);
    for (unsigned corner = 0; corner < 4; ++corner) {
      const FaceId face = face_id(cell, corner), other = mesh.opposite(face);
      if (other == no_face) continue;
      ASSERT_EQ(mesh.opposite(other), face);
      auto mine = mesh.face_vertices(face), theirs = mesh.face_vertices(other);
      std::sort(mine.begin(), mine.end());
      std::sort(theirs.begin(), theirs.end());
      ASSERT_EQ(mine, theirs);
      const Point& apex = mesh.point(mesh.corners(cell_of(other))[corner_of(other)]);
      ASSERT_FALSE(predicates::in_sphere_exact(mesh.point(v[0]), mesh.point(v[1]), mesh.point(v[2]),
                                               mesh.point(v[3]), apex));
    }
  }
  EXPECT_EQ(alive, mesh.cell_count());
}

TEST_P(DelaunayTriangulation, EveryConflictDecisionIsExact) {
  Triangulation mesh(box_around(GetParam().points));
  insert_all(mesh, GetParam().points);
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  std::size_t decisions = 0;
  for (Index cell = 0; cell < mesh.cell_capacity(); ++cell) {
    if (!mesh.alive(cell)) continue;
    const auto& v = mesh.corners(cell);
    const double r = std::sqrt(mesh.squared_radius(cell));
    std::vector<Point> queries{mesh.circumcentre(cell), mesh.point(v[0]), mesh.point(v[3])};
    for (int k = 0; k < 6; ++k) {  // points on the sphere up to rounding, and a little off it
      const Vector d{normal(random), normal(random), normal(random)};
      queries.push_back(mesh.circumcentre(cell) + (r * (1 + 1e-15 * k)) / norm(d) * d);
    }
    for (unsigned corner = 0; corner < 4; ++corner)
      if (const FaceId other = mesh.opposite(face_id(cell, corner)); other != no_face)
        queries.push_back(mesh.point(mesh.corners(cell_of(other))[corner_of(other)]));
    for (const Point& p : queries) {
      ++decisions;
      ASSERT_EQ(mesh.in_conflict(cell, p),
                predicates::in_sphere_exact(mesh.point(v[0]), mesh.point(v[1]), mesh.point(v[2]),
                                            mesh.point(v[3]), p));
    }
  }
  EXPECT_GT(decisions, 1000U);
}

TEST_P(DelaunayTriangulation, HasTheCellsOfTheOracle) {
  const auto& points = GetParam().points;
  Triangulation mesh(box_around(points));
  insert_all(mesh, points);
  using Cell = std::array<std::array<double, 3>, 4>;
  std::set<Cell> mine, theirs;
  for (Index cell = 0; cell < mesh.cell_capacity(); ++cell) {
    if (!mesh.alive(cell)) continue;
    Cell key;
    for (unsigned i = 0; i < 4; ++i) {
      const Point& p = mesh.point(mesh.corners(cell)[i]);
      key[i] = {p.x, p.y, p.z};
    }
    std::sort(key.begin(), key.end());
    mine.insert(key);
  }
  std::vector<Kernel::Point_3> all;
  for (Index v = 0; v < mesh.vertex_count(); ++v)
    all.emplace_back(mesh.point(v).x, mesh.point(v).y, mesh.point(v).z);
  const Oracle oracle(all.begin(), all.end());
  for (const auto& cell : oracle.finite_cell_handles()) {
    Cell key;
    for (int i = 0; i < 4; ++i) {
      const auto& p = cell->vertex(i)->point();
      key[static_cast<std::size_t>(i)] = {p.x(), p.y(), p.z()};
    }
    std::sort(key.begin(), key.end());
    theirs.insert(key);
  }
  EXPECT_NEAR(double(mine.size()), double(theirs.size()), 0.1 * double(theirs.size()));
  // Expects that the triangulations differ only by ties (the box's corners tie in every set): a cell that
  // only one of them has must have a fifth point on its sphere.
  std::vector<Cell> missing;
  std::set_difference(mine.begin(), mine.end(), theirs.begin(), theirs.end(), std::back_inserter(missing));
  for (const Cell& cell : missing) {
    std::array<Point, 4> c;
    for (std::size_t i = 0; i < 4; ++i) c[i] = {cell[i][0], cell[i][1], cell[i][2]};
    std::size_t on_sphere = 0;
    for (Index v = 0; v < mesh.vertex_count(); ++v) {
      const Point& p = mesh.point(v);
      if (!predicates::in_sphere_exact(c[0], c[1], c[2], c[3], p) &&
          !predicates::in_sphere_exact(c[0], c[2], c[1], c[3], p))
        ++on_sphere;
    }
    ASSERT_GT(on_sphere, 4U);
  }
}

INSTANTIATE_TEST_SUITE_P(PointSets, DelaunayTriangulation,
                         ::testing::Values(random_points("random", 1500, {}, 1),
                                           random_points("tiny", 700, {}, 1e-9),
                                           random_points("far_from_the_origin", 700, {1e6, -3e6, 2e6}, 1),
                                           grid("grid", 8, {}, 0), grid("near_grid", 8, {}, 1e-13),
                                           grid("near_grid_far_away", 8, {1e6, 1e6, 1e6}, 1e-9),
                                           on_sphere(400), on_plane_and_line()),
                         [](const auto& info) { return info.param.name; });

TEST(DelaunayTriangulationZone, OfAVertexWithManyNeighboursIsLinked) {
  // A vertex inside a sphere of 600 others has too many neighbours for the square table.
  const PointSet sphere = on_sphere(600);
  Box box;
  box.add(Point{-4, -4.1, -4.2});
  box.add(Point{4, 4.1, 4.2});
  Triangulation mesh(box);
  ConflictZone zone;
  const auto insert = [&](const Point& p) {
    Index cell = 0;
    while (!mesh.alive(cell) || !mesh.in_conflict(cell, p)) ++cell;
    mesh.find_conflict_zone(p, cell, zone);
    mesh.insert(zone);
  };
  for (const Point& p : sphere.points) insert(p);
  insert({1e-3, 2e-3, 0});
  EXPECT_GT(zone.vertices.size(), 256U);
  for (const Index cell : zone.created)
    for (unsigned corner = 0; corner < 4; ++corner) {
      const FaceId face = face_id(cell, corner);
      if (mesh.opposite(face) != no_face) {
        EXPECT_EQ(mesh.opposite(mesh.opposite(face)), face);
      }
    }
}

// Compares with integers: vectors that are parallel, nearly parallel or any, with zeros, at scales whose
// products underflow or overflow.
TEST(Predicates, SignsOfCrossProductsAreExact) {
  __extension__ using Wide = __int128;
  using Integers = std::array<std::int64_t, 3>;
  std::mt19937_64 random(5);
  const auto vector = [&](std::int64_t largest) {
    std::uniform_int_distribution<std::int64_t> any(-largest, largest);
    Integers v{any(random), any(random), any(random)};
    for (std::int64_t& x : v)
      if (random() % 4 == 0) x = 0;
    return v;
  };
  const auto sum = [](const Integers& a, const Integers& b) {
    return Integers{a[0] + b[0], a[1] + b[1], a[2] + b[2]};
  };
  std::array<int, 3> found{};
  for (int i = 0; i < 20'000; ++i) {
    const std::int64_t largest = i % 2 == 0 ? 1 << 10 : std::int64_t{1} << 48;
    const Integers u = vector(largest);
    Integers v = vector(largest);
    if (i % 3 != 0) v = sum({-u[0], -u[1], -u[2]}, i % 3 == 1 ? Integers{} : vector(1));
    const Integers p = vector(largest), a = vector(largest), q = sum(p, u), b = sum(a, v);
    int wanted = 0;
    for (std::size_t axis = 0; axis < 3 && wanted == 0; ++axis) {
      const std::size_t j = (axis + 1) % 3, k = (axis + 2) % 3;
      const Wide left = Wide{u[j]} * v[k], right = Wide{u[k]} * v[j];
      wanted = left > right ? 1 : left < right ? -1 : 0;
    }
    for (const int exponent : {0, -560, 900}) {
      const auto at = [&](const Integers& x) {
        const auto scaled = [&](std::int64_t y) { return std::ldexp(static_cast<double>(y), exponent); };
        return Point{scaled(x[0]), scaled(x[1]), scaled(x[2])};
      };
      ASSERT_EQ(predicates::cross_product_sign_exact(at(p), at(q), at(a), at(b)), wanted);
    }
    ++found[static_cast<std::size_t>(wanted + 1)];
  }
  for (const int count : found) EXPECT_GT(count, 1000);
}

}  // namespace
}  // namespace collarmesh::delaunay_triangulation_test
