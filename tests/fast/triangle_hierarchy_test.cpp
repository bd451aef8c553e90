#include "location/triangle_hierarchy.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

namespace collarmesh::triangle_hierarchy_test {
namespace {

using Triangles = std::vector<std::array<Index, 3>>;

struct Soup {
  std::vector<Point> points;
  Triangles triangles;
};

Soup random_triangles(std::size_t n, double extent) {
  std::mt19937_64 random(17);
  std::uniform_real_distribution<double> unit(0, 1);
  Soup soup;
  for (std::size_t i = 0; i < n; ++i) {
    const Point at{unit(random), unit(random), unit(random)};
    for (int k = 0; k < 3; ++k)
      soup.points.push_back(at + extent * Point{unit(random), unit(random), unit(random)});
    const auto first = static_cast<Index>(3 * i);
    soup.triangles.push_back({first, first + 1, first + 2});
  }
  return soup;
}

// Returns the surface of [0, n]^3 in unit squares, each cut in two: full of ties for axis-parallel segments.
Soup box_surface(int n) {
  Soup soup;
  const auto corner = [&](int axis, int side, int i, int j) {
    Point p;
    p[static_cast<std::size_t>(axis)] = side * n;
    p[static_cast<std::size_t>((axis + 1) % 3)] = i;
    p[static_cast<std::size_t>((axis + 2) % 3)] = j;
    const auto found = std::find(soup.points.begin(), soup.points.end(), p);
    if (found != soup.points.end()) return static_cast<Index>(found - soup.points.begin());
    soup.points.push_back(p);
    return static_cast<Index>(soup.points.size() - 1);
  };
  for (int axis = 0; axis < 3; ++axis)
    for (int side = 0; side < 2; ++side)
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
          const Index a = corner(axis, side, i, j), b = corner(axis, side, i + 1, j),
                      c = corner(axis, side, i + 1, j + 1), d = corner(axis, side, i, j + 1);
          if (side == 1)
            soup.triangles.insert(soup.triangles.end(), {{a, b, c}, {a, c, d}});
          else
            soup.triangles.insert(soup.triangles.end(), {{a, c, b}, {a, d, c}});
        }
  return soup;
}

Box box_about(const Point& centre, double half) {
  const Vector to_corner{half, half, half};
  return {centre - to_corner, centre + to_corner};
}

TEST(TriangleHierarchy, NodesInABoxCoverItsTriangles) {
  const Soup soup = random_triangles(500, 0.05);
  TriangleHierarchy hierarchy(soup.points, soup.triangles);
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> unit(0, 1);
  TriangleHierarchy::Marks marks;
  std::vector<Index> coarse, fine;
  std::vector<TriangleHierarchy::Crossing> crossings;
  for (int k = 0; k < 200; ++k) {
    const Point centre{unit(random), unit(random), unit(random)};
    const double radius = 0.3 * unit(random);
    const Index root = hierarchy.root();
    hierarchy.nodes_meeting(box_about(centre, 0.6), 0.6, {&root, 1}, marks, coarse);
    hierarchy.nodes_meeting(box_about(centre, radius), radius, coarse, marks, fine);
    // Any segment inside the box must find the same crossings from these nodes as from the root.
    for (int s = 0; s < 10; ++s) {
      const auto inside = [&] {
        return centre + 2 * radius * Vector{unit(random) - 0.5, unit(random) - 0.5, unit(random) - 0.5};
      };
      const Point p = inside(), q = inside();
      hierarchy.crossings(p, q, fine, crossings);
      std::vector<Index> found, expected;
      for (const auto& crossing : crossings) found.push_back(crossing.triangle);
      hierarchy.crossings(p, q, {&root, 1}, crossings);
      for (const auto& crossing : crossings) expected.push_back(crossing.triangle);
      std::sort(found.begin(), found.end());
      std::sort(expected.begin(), expected.end());
      ASSERT_EQ(found, expected);
    }
  }
}

// The box of an oblique triangle contains many places far from the triangle. Touching counts as meeting.
TEST(TriangleHierarchy, LargeTrianglesAreFoundWhereTheirPlanesAre) {
  const std::vector<Point> points{{0, 0, 0}, {1, 1, 0}, {0, 0, 1}};
  TriangleHierarchy hierarchy(points, {{0, 1, 2}});
  const Index root = hierarchy.root();
  TriangleHierarchy::Marks marks;
  std::vector<Index> found;
  for (const auto& [centre, count] : {std::pair<Point, std::size_t>{{0.8, 0.2, 0.2}, 0},
                                      {{0.2, 0.8, 0.2}, 0},
                                      {{0.55, 0.45, 0.2}, 1},
                                      {{0.25, 0.125, 0.2}, 1},
                                      {{0.25, 0.125 - 0x1p-30, 0.2}, 0}}) {
    hierarchy.nodes_meeting(box_about(centre, 0.125 / 2), 0.125 / 2, {&root, 1}, marks, found);
    EXPECT_EQ(found.size(), count) << centre.x << ' ' << centre.y;
  }
}

// Checks likewise the box of an oblique segment, which is a triangle with equal corners.
TEST(TriangleHierarchy, LongSegmentsAreFoundWhereTheyAre) {
  const std::vector<Point> points{{0, 0, 0}, {1, 1, 1}};
  TriangleHierarchy hierarchy(points, {{0, 1, 1}});
  const Index root = hierarchy.root();
  TriangleHierarchy::Marks marks;
  std::vector<Index> found;
  for (const auto& [centre, count] : {std::pair<Point, std::size_t>{{0.5, 0.5, 0.5}, 1},
                                      {{0.5, 0.5, 0.375}, 1},
                                      {{0.5, 0.5, 0.375 - 0x1p-30}, 0},
                                      {{0.8, 0.2, 0.5}, 0},
                                      {{0.2, 0.6, 0.6}, 0},
                                      {{1.0625, 1.0625, 1.0625}, 1}}) {
    hierarchy.nodes_meeting(box_about(centre, 0.125 / 2), 0.125 / 2, {&root, 1}, marks, found);
    EXPECT_EQ(found.size(), count) << centre.x << ' ' << centre.y << ' ' << centre.z;
  }
}

TEST(TriangleHierarchy, NodesDoNotOverlap) {
  const Soup soup = random_triangles(300, 0.05);
  TriangleHierarchy hierarchy(soup.points, soup.triangles);
  const Index root = hierarchy.root();
  TriangleHierarchy::Marks marks;
  std::vector<Index> first, second, both;
  hierarchy.nodes_meeting(box_about({0.4, 0.5, 0.5}, 0.05), 0.05, {&root, 1}, marks, first);
  hierarchy.nodes_meeting(box_about({0.5, 0.5, 0.5}, 0.3), 0.3, {&root, 1}, marks, second);
  both = first;
  both.insert(both.end(), second.begin(), second.end());
  std::vector<Index> found;
  hierarchy.nodes_meeting(box_about({0.45, 0.5, 0.5}, 0.15), 0.15, both, marks, found);
  std::vector<TriangleHierarchy::Crossing> crossings;
  hierarchy.crossings({0.31, 0.5, 0.5}, {0.59, 0.5, 0.5}, found, crossings);
  std::vector<Index> triangles;
  for (const auto& crossing : crossings) triangles.push_back(crossing.triangle);
  std::sort(triangles.begin(), triangles.end());
  EXPECT_EQ(std::adjacent_find(triangles.begin(), triangles.end()), triangles.end());
}

TEST(TriangleHierarchy, AClosedSurfaceIsCrossedConsistentlyWhateverTheTies) {
  constexpr int n = 4;
  const Soup soup = box_surface(n);
  const TriangleHierarchy hierarchy(soup.points, soup.triangles);
  const Index root = hierarchy.root();
  std::vector<TriangleHierarchy::Crossing> crossings;
  std::mt19937_64 random(2);
  // Half-integer lattice points: on faces, edges, corners and diagonals of the tessellation.
  std::uniform_int_distribution<int> lattice(-2, 2 * n + 2);
  const auto point = [&] {
    return 0.5 * Point{double(lattice(random)), double(lattice(random)), double(lattice(random))};
  };
  // A point on the surface counts as moved by (e, e^2, e^3).
  const auto inside = [&](const Point& p) {
    return p.x >= 0 && p.x < n && p.y >= 0 && p.y < n && p.z >= 0 && p.z < n;
  };
  for (int k = 0; k < 20000; ++k) {
    const Point p = point(), q = point();
    hierarchy.crossings(p, q, {&root, 1}, crossings);
    int depth = inside(p) ? 1 : 0;
    for (const auto& crossing : crossings) depth -= crossing.direction;
    ASSERT_EQ(depth, inside(q) ? 1 : 0)
        << p.x << ' ' << p.y << ' ' << p.z << " to " << q.x << ' ' << q.y << ' ' << q.z;
  }
}

// Uses neighbourhoods from far larger than the triangles to far smaller, with segments as long as the
// neighbourhood and far shorter. On the boxes' surface every test is a tie.
void expect_the_crossings_of_each_segment(const Soup& soup, bool on_a_grid) {
  const TriangleHierarchy hierarchy(soup.points, soup.triangles);
  Box bounds;
  for (const Point& p : soup.points) bounds.add(p);
  const double extent = distance(bounds.min, bounds.max);
  const Index root = hierarchy.root();
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto direction = [&] { return Vector{unit(random), unit(random), unit(random)}; };
  SegmentBundle bundle;
  std::vector<TriangleHierarchy::BundleCrossing> found;
  std::vector<TriangleHierarchy::Crossing> expected;
  std::size_t crossed = 0;
  for (int k = 0; k < 300; ++k) {
    const double radius = extent * std::pow(10, -(k % 12));
    Point centre = soup.points[random() % soup.points.size()] + 0.3 * radius * direction();
    if (on_a_grid) centre = soup.points[random() % soup.points.size()];
    bundle.start(centre, radius);
    std::vector<Point> points;
    const auto count = static_cast<Index>(2 + random() % 150);
    for (Index i = 0; i < count; ++i) {
      Point p = centre + 0.5 * radius * direction();
      if (on_a_grid && k % 12 < 2) p = {std::round(p.x), std::round(p.y), std::round(p.z)};
      if (i > 0 && random() % 3 == 0) p = points[i - 1] + 1e-7 * radius * direction();
      points.push_back(p);
      bundle.add_point(p);
      if (i > 0) bundle.add_segment(i - 1, i);
    }
    hierarchy.crossings(bundle, {&root, 1}, found);
    std::size_t next = 0;
    for (Index i = 0; i + 1 < count; ++i) {
      hierarchy.crossings(points[i], points[i + 1], {&root, 1}, expected);
      for (const auto& [triangle, way] : expected) {
        const auto same = std::find_if(found.begin() + static_cast<std::ptrdiff_t>(next), found.end(),
                                       [&, wanted = triangle](const TriangleHierarchy::BundleCrossing& c) {
                                         return c.segment == i && c.crossing.triangle == wanted;
                                       });
        ASSERT_NE(same, found.end()) << "radius " << radius << ", segment " << i;
        EXPECT_EQ(same->crossing.direction, way);
      }
      next += expected.size();
    }
    EXPECT_EQ(found.size(), next);
    crossed += next;
  }
  EXPECT_GT(crossed, 500U);
}

TEST(TriangleHierarchy, ABundleFindsTheCrossingsOfEachSegment) {
  expect_the_crossings_of_each_segment(random_triangles(500, 0.05), false);
  expect_the_crossings_of_each_segment(box_surface(5), true);
}

TEST(TriangleHierarchy, DistanceEqualsBruteForce) {
  const Soup soup = random_triangles(400, 0.2);
  const TriangleHierarchy hierarchy(soup.points, soup.triangles);
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> unit(-0.5, 1.5);
  for (int k = 0; k < 300; ++k) {
    const Point p{unit(random), unit(random), unit(random)};
    double expected = INFINITY;
    for (const auto& t : soup.triangles)
      expected = std::min(
          expected, squared_distance_to_triangle(p, soup.points[t[0]], soup.points[t[1]], soup.points[t[2]]));
    Index nearest = none;
    ASSERT_EQ(hierarchy.squared_distance_to(p, INFINITY, &nearest), expected);
    ASSERT_LT(nearest, soup.triangles.size());
  }
}

// Labels by octant: the nodes that contain only triangles of one octant leave these out.
TEST(TriangleHierarchy, NodesWithACommonLabelAreLeftOut) {
  const Soup soup = random_triangles(400, 0.05);
  const TriangleHierarchy hierarchy(soup.points, soup.triangles);
  std::vector<Index> label_of;
  for (const auto& t : soup.triangles) {
    const Point& p = soup.points[t[0]];
    label_of.push_back((p.x < 0.5 ? 0U : 1U) + (p.y < 0.5 ? 0U : 2U) + (p.z < 0.5 ? 0U : 4U));
  }
  const std::vector<Index> labels = hierarchy.common_labels(label_of);
  EXPECT_EQ(labels[hierarchy.root()], none);
  const Index root = hierarchy.root();
  for (Index octant = 0; octant < 8; ++octant) {
    std::vector<Index> found, expected;
    hierarchy.visit_near(
        {&root, 1}, {0.5, 0.5, 0.5}, INFINITY, [&](Index node) { return labels[node] == octant; },
        [&](Index triangle) { found.push_back(triangle); });
    for (Index t = 0; t < label_of.size(); ++t)
      if (label_of[t] != octant) expected.push_back(t);
    std::sort(found.begin(), found.end());
    EXPECT_EQ(found, expected);
  }
  // All triangles have one label: nothing is visited.
  const std::vector<Index> same = hierarchy.common_labels(std::vector<Index>(label_of.size(), 3));
  hierarchy.visit_near(
      {&root, 1}, {0.5, 0.5, 0.5}, INFINITY, [&](Index node) { return same[node] == 3; },
      [&](Index) { ADD_FAILURE(); });
}

// Two tilted sheets along each other, the first one coarse: finding the nearest point on it does not visit
// the whole second one.
TEST(TriangleHierarchy, TheNearestOfOneLabelLooksAtFewOfAnother) {
  Soup soup;
  std::vector<Index> label_of;
  for (const Index label : {0U, 1U}) {
    const int n = label == 0 ? 2 : 60;
    const auto first = static_cast<Index>(soup.points.size());
    for (int i = 0; i <= n; ++i)
      for (int j = 0; j <= n; ++j) {
        const double x = static_cast<double>(i) / n, y = static_cast<double>(j) / n;
        soup.points.push_back({x, y, x + y + 1e-3 * label});
      }
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) {
        const auto a = first + static_cast<Index>(i * (n + 1) + j), b = a + static_cast<Index>(n) + 1;
        soup.triangles.insert(soup.triangles.end(), {{a, b, b + 1}, {a, b + 1, a + 1}});
        label_of.insert(label_of.end(), {label, label});
      }
  }
  const TriangleHierarchy hierarchy(soup.points, soup.triangles);
  const std::vector<Index> labels = hierarchy.common_labels(label_of);
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> unit(0, 1);
  std::size_t looked_at = 0;
  constexpr std::size_t queries = 200;
  for (std::size_t k = 0; k < queries; ++k) {
    const Point p{unit(random), unit(random), 2 * unit(random)};
    Index expected = none, nearest = none;
    const double squared = hierarchy.squared_distance_to(
        p, INFINITY, &expected, [&](Index triangle) { return label_of[triangle] == 0; });
    EXPECT_EQ(hierarchy.squared_distance_to(
                  p, INFINITY, &nearest, [&](Index node) { return labels[node] == 1; },
                  [&](Index triangle) {
                    ++looked_at;
                    return label_of[triangle] == 0;
                  }),
              squared);
    EXPECT_EQ(nearest, expected);
  }
  EXPECT_LE(looked_at, 8 * queries);
}

TEST(TriangleHierarchy, DistanceToATriangleIsThatOfSampledPoints) {
  const Point a{0, 0, 0}, b{1, 0, 0}, c{0.2, 0.9, 0.1};
  std::mt19937_64 random(6);
  std::uniform_real_distribution<double> unit(-1, 2);
  for (int k = 0; k < 50; ++k) {
    const Point p{unit(random), unit(random), unit(random)};
    double sampled = INFINITY;
    for (int i = 0; i <= 200; ++i)
      for (int j = 0; i + j <= 200; ++j)
        sampled = std::min(sampled, distance(p, a + i / 200.0 * (b - a) + j / 200.0 * (c - a)));
    const double d = std::sqrt(squared_distance_to_triangle(p, a, b, c));
    EXPECT_LE(d, sampled + 1e-12);
    EXPECT_GE(d, sampled - 0.006);
  }
}

// Tests places on all sides of triangles, of needles, and of triangles whose corners are collinear or equal.
TEST(TriangleHierarchy, WithinADistanceIsNearerThanIt) {
  std::mt19937_64 random(8);
  std::uniform_real_distribution<double> unit(-1, 1);
  unsigned within = 0, beyond = 0;
  for (int k = 0; k < 200000; ++k) {
    const auto point = [&] { return Point{unit(random), unit(random), unit(random)}; };
    const Point a = point(), b = point();
    const double height = k % 4 == 0 ? 1 : std::pow(10.0, -2.0 * (k % 7));
    const Point c = k % 11 == 0   ? b
                    : k % 13 == 0 ? a + unit(random) * (b - a)
                                  : a + unit(random) * (b - a) + height * (point() - Point{});
    const Point p =
        a + 1.5 * unit(random) * (b - a) + 1.5 * unit(random) * (c - a) + 0.3 * (point() - Point{});
    const double squared = squared_distance_to_triangle(p, a, b, c), bound = 0.1 * std::fabs(unit(random));
    if (std::fabs(squared - bound) < 1e-9) continue;
    EXPECT_EQ(is_within(bound, p, a, b, c), squared < bound) << k << ' ' << squared << ' ' << bound;
    ++(squared < bound ? within : beyond);
  }
  EXPECT_GT(within, 20000U);
  EXPECT_GT(beyond, 20000U);
}

TEST(TriangleHierarchy, FindsATriangleWithinADistanceWithAndWithoutAHint) {
  const Soup soup = random_triangles(400, 0.05);
  const TriangleHierarchy hierarchy(soup.points, soup.triangles);
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> unit(0, 1);
  const auto distance_to = [&](const Point& p, Index t) {
    const auto c = hierarchy.corners(t);
    return squared_distance_to_triangle(p, c[0], c[1], c[2]);
  };
  std::size_t none_near = 0;
  for (int i = 0; i < 500; ++i) {
    const Point p{unit(random), unit(random), unit(random)};
    const double bound = 0.003 * unit(random);
    bool any = false, any_even = false;
    for (Index t = 0; t < soup.triangles.size(); ++t) {
      any = any || distance_to(p, t) < bound;
      any_even = any_even || (t % 2 == 0 && distance_to(p, t) < bound);
    }
    none_near += any ? 0 : 1;
    const auto hint = static_cast<Index>(2 * (random() % (soup.triangles.size() / 2)));
    const Index found = hierarchy.triangle_within(p, bound),
                hinted = hierarchy.triangle_within(p, bound, hint),
                even = hierarchy.triangle_within(p, bound, hint, [](Index t) { return t % 2 == 0; });
    EXPECT_EQ(found != none, any);
    EXPECT_EQ(hinted != none, any);
    EXPECT_EQ(even != none, any_even);
    for (const Index t : {found, hinted, even}) EXPECT_TRUE(t == none || distance_to(p, t) < bound);
    EXPECT_TRUE(distance_to(p, hint) >= bound || hinted == hint);
  }
  EXPECT_GT(none_near, 50U);
  EXPECT_LT(none_near, 450U);
}

}  // namespace
}  // namespace collarmesh::triangle_hierarchy_test
