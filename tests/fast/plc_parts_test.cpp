// Parts of the builder whose work is hard to see in a complex.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <set>

#include "collarmesh/plc_builder.h"
#include "common/patch_points.h"
#include "delaunay/predicates.h"
#include "facets/edges.h"
#include "facets/flat_clusters.h"
#include "facets/orientation.h"
#include "support/shapes.h"

namespace collarmesh::plc::plc_parts_test {

using namespace facets;

namespace {

// Makes a grid of n x n squares, each cut in two; `height` returns the height at a point.
template <class Height>
ComplexDraft terrain(Index n, const Height& height) {
  ComplexDraft draft;
  for (Index i = 0; i <= n; ++i)
    for (Index j = 0; j <= n; ++j)
      draft.points.push_back({static_cast<double>(i), static_cast<double>(j), height(i, j)});
  const auto at = [&](Index i, Index j) { return i * (n + 1) + j; };
  for (Index i = 0; i < n; ++i)
    for (Index j = 0; j < n; ++j) {
      Origin origin;
      origin.facet = static_cast<Index>(draft.triangles.size());
      draft.add_triangle({at(i, j), at(i + 1, j), at(i + 1, j + 1)}, origin);
      ++origin.facet;
      draft.add_triangle({at(i, j), at(i + 1, j + 1), at(i, j + 1)}, origin);
    }
  for (const Point& p : draft.points) draft.bounds.add(p);
  return draft;
}

void expect_table_of(const ComplexDraft& draft, const EdgeTable& edges) {
  const EdgeTable expected(draft.triangles, draft.points.size());
  ASSERT_EQ(edges.size(), expected.size());
  for (Index e = 0; e < edges.size(); ++e) {
    EXPECT_EQ(edges.ends(e), expected.ends(e));
    EXPECT_TRUE(std::ranges::equal(edges.sides(e), expected.sides(e)));
  }
  for (Index side = 0; side < 3 * draft.triangles.size(); ++side)
    EXPECT_EQ(edges.edge_of(side), expected.edge_of(side));
}

TEST(EdgeTable, FollowsTurnedTriangles) {
  ComplexDraft draft = terrain(6, [](Index, Index) { return 0.0; });
  // Several triangles on one edge, and reversed ones beside others.
  draft.add_triangle({0, 8, 20}, {});
  draft.add_triangle({8, 0, 30}, {});
  EdgeTable edges(draft.triangles, draft.points.size());
  std::mt19937 random(1);
  for (int turn = 0; turn < 60; ++turn) {
    const auto t = static_cast<Index>(random() % draft.triangles.size());
    std::swap(draft.triangles[t][1], draft.triangles[t][2]);
    edges.turn(t);
  }
  expect_table_of(draft, edges);
}

TEST(EdgeTable, IsThatOfTheOrientedTriangles) {
  ComplexDraft draft = terrain(8, [](Index i, Index j) { return 0.1 * i * j; });
  std::mt19937 random(2);
  for (Corners& t : draft.triangles)
    if (random() % 3 == 0) std::swap(t[1], t[2]);
  EdgeTable edges(draft.triangles, draft.points.size());
  Faults faults;
  orient_components(draft, edges, faults);
  EXPECT_TRUE(faults.empty());
  for (Index e = 0; e < edges.size(); ++e) {
    const auto sides = edges.sides(e);
    if (sides.size() < 2) continue;
    EXPECT_NE(ascending(draft.triangles, sides[0]), ascending(draft.triangles, sides[1]));
  }
  expect_table_of(draft, edges);
}

// The other soup's triangles on the same edges do not affect the orientation of this soup's.
TEST(Orientation, LooksAtTheSidesOfItsSoupOnly) {
  ComplexDraft draft = terrain(4, [](Index, Index) { return 0.0; });
  const std::size_t count = draft.triangles.size();
  for (std::size_t t = 0; t < count; ++t) {
    Origin other = draft.origins[t];
    other.soup = 1;
    draft.add_triangle(draft.triangles[t], other);
  }
  std::swap(draft.triangles[3][1], draft.triangles[3][2]);
  EdgeTable edges(draft.triangles, draft.points.size());
  Faults faults;
  orient_components(draft, edges, faults);
  EXPECT_TRUE(faults.empty());
  EXPECT_FALSE(draft.origins[0].oriented);     // a triangle of its component was turned
  EXPECT_TRUE(draft.origins[count].oriented);  // none was turned
  EXPECT_EQ(draft.triangles[3], draft.triangles[count + 3]);
}

// Finds seeds by their definition: triangles, the largest first, collect their neighbours in their plane or
// facet, and the neighbours of these.
std::vector<Index> seeds_one_by_one(const ComplexDraft& draft, const EdgeTable& edges) {
  const auto side = [&](Index t, unsigned i) { return draft.corner(t, (i + 1) % 3) - draft.corner(t, i); };
  const auto area = [&](Index t) {
    return 0.5 *
           norm(cross(draft.corner(t, 1) - draft.corner(t, 0), draft.corner(t, 2) - draft.corner(t, 0)));
  };
  const auto height = [&](Index t) {
    return 2 * area(t) / std::max({norm(side(t, 0)), norm(side(t, 1)), norm(side(t, 2))});
  };
  const auto tolerance = [&](Index seed) {
    return std::min(draft.planar_tolerance, std::max(0.1 * height(seed), draft.rounding()));
  };
  const auto in_plane = [&](const Point& p, Index seed) {
    const Point& a = draft.corner(seed, 0);
    if (draft.planar_tolerance > 0) return std::fabs(dot(unit_normal(draft, seed), p - a)) <= tolerance(seed);
    return predicates::orientation_exact(a, draft.corner(seed, 1), draft.corner(seed, 2), p) == 0;
  };
  std::vector<Index> order(draft.triangles.size()), seeds(order.size(), none);
  std::iota(order.begin(), order.end(), Index{0});
  std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) { return area(a) > area(b); });
  for (const Index seed : order) {
    if (seeds[seed] != none) continue;
    std::vector<Index> stack{seed};
    seeds[seed] = seed;
    while (!stack.empty()) {
      const Index t = stack.back();
      stack.pop_back();
      for (Index i = 3 * t; i < 3 * t + 3; ++i)
        for (const Index other : edges.sides(edges.edge_of(i))) {
          const Index neighbour = other / 3;
          const bool alike = dot(unit_normal(draft, seed), unit_normal(draft, neighbour)) > 0 ||
                             height(neighbour) <= 2 * tolerance(seed);
          const bool joins = draft.origins[t].facet == draft.origins[neighbour].facet ||
                             (in_plane(draft.points[apex(draft.triangles, other)], seed) && alike);
          if (seeds[neighbour] != none || !joins) continue;
          seeds[neighbour] = seed;
          stack.push_back(neighbour);
        }
    }
  }
  return seeds;
}

// Grids with points off their places, heights of a few tolerances or none, needles, and facets of two
// triangles.
ComplexDraft random_terrain(std::uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(-1, 1);
  const double tolerance = seed % 4 == 0 ? 0 : 0.01, roughness = std::pow(10, unit(random));
  ComplexDraft draft = terrain(9, [&](Index, Index) {
    return tolerance > 0 ? roughness * tolerance * unit(random) : (random() % 4 == 0 ? 0.5 : 0.0);
  });
  for (Point& p : draft.points) {
    p.x += 0.45 * unit(random);
    p.y += (random() % 20 == 0 ? 0.99 : 0.3) * unit(random);
  }
  for (std::size_t t = 0; t + 1 < draft.triangles.size(); t += 2)
    if (random() % 5 == 0) draft.origins[t + 1].facet = draft.origins[t].facet;
  draft.planar_tolerance = tolerance;
  return draft;
}

TEST(FlatClusters, AreThoseOfTheirDefinition) {
  std::size_t clusters = 0, triangles = 0;
  for (std::uint32_t seed = 0; seed < 200; ++seed) {
    const ComplexDraft draft = random_terrain(seed);
    const EdgeTable edges(draft.triangles, draft.points.size());
    const auto seeds = find_flat_clusters(draft, edges).seed;
    ASSERT_EQ(seeds, seeds_one_by_one(draft, edges)) << seed;
    for (Index t = 0; t < seeds.size(); ++t) clusters += seeds[t] == t ? 1 : 0;
    triangles += seeds.size();
  }
  // Not all triangles are in one cluster, nor each in its own.
  EXPECT_GT(clusters, triangles / 10);
  EXPECT_LT(clusters, triangles * 9 / 10);
}

TEST(PatchPoints, HasTheCornersOfEachPatchOnce) {
  const Plc plc = build_plc(std::vector{testing::plate_with_hole(1, 16)}, {});
  const PatchPoints points(plc);
  ASSERT_GT(plc.patches.size(), 2U);
  for (Index patch = 0; patch < plc.patches.size(); ++patch) {
    std::set<Index> expected;
    for (const Plc::Triangle& t : plc.triangles)
      if (t.patch == patch) expected.insert(t.points.begin(), t.points.end());
    EXPECT_TRUE(std::ranges::equal(points[patch], expected));
  }
}

}  // namespace
}  // namespace collarmesh::plc::plc_parts_test
