// Edges that the input forces to be short, and the width and angle that they leave to a tet, by brute force.
#include "tolerance/forced_edges.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <set>

#include "collarmesh/plc_builder.h"
#include "remesh/thin_shape.h"
#include "support/shapes.h"

namespace collarmesh::forced_edges_test {
namespace {

using Corners = std::array<Point, 4>;
constexpr std::array<Index, 4> four{0, 1, 2, 3};

// Returns all points of the complex on a feature and on its border.
std::set<Index> points_of(const Plc& plc, unsigned dimension, Index feature) {
  if (dimension == 0) return {plc.vertices[feature].point};
  if (dimension == 1) return {plc.curves[feature].points.begin(), plc.curves[feature].points.end()};
  std::set<Index> points;
  const Plc::Patch& patch = plc.patches[feature];
  for (Index t = patch.first_triangle; t < patch.first_triangle + patch.triangle_count; ++t)
    points.insert(plc.triangles[t].points.begin(), plc.triangles[t].points.end());
  return points;
}

Plc complex_of(const PolygonSoup& soup, double feature_angle = 30) {
  PlcOptions options;
  options.feature_angle = feature_angle;
  return build_plc({&soup, 1}, options);
}

void expect_contacts_by_points(const Plc& plc) {
  const FeatureContacts contacts(plc);
  const std::array<std::size_t, 3> counts{plc.vertices.size(), plc.curves.size(), plc.patches.size()};
  unsigned touching = 0, apart = 0;
  for (unsigned d = 0; d < 3; ++d)
    for (Index f = 0; f < counts[d]; ++f)
      for (unsigned e = 0; e < 3; ++e)
        for (Index g = 0; g < counts[e]; ++g) {
          const std::set<Index> a = points_of(plc, d, f), b = points_of(plc, e, g);
          const bool expected = std::any_of(a.begin(), a.end(), [&](Index p) { return b.contains(p); });
          EXPECT_EQ(contacts.touch(d, f, e, g), expected) << d << ' ' << f << ' ' << e << ' ' << g;
          ++(expected ? touching : apart);
        }
  EXPECT_GT(touching, 0U);
  EXPECT_GT(apart, 0U);
}

TEST(FeatureContacts, AreThoseWithACommonPoint) {
  expect_contacts_by_points(complex_of(testing::two_boxes()));
  expect_contacts_by_points(complex_of(testing::l_shape()));
  expect_contacts_by_points(complex_of(testing::cylinder(1, 2, 24), 40));
  // 80 flat faces meet in the cone's tip: too many to be listed as neighbours of each other.
  expect_contacts_by_points(complex_of(testing::cone(1, 1, 80), 0));
}

Corners any_corners(std::mt19937& random) {
  std::uniform_real_distribution<double> place(-1, 1);
  Corners p;
  for (Point& corner : p) corner = {place(random), place(random), 0.1 * place(random)};
  return p;
}

double longest(const Corners& p) {
  double most = 0;
  for (unsigned i = 0; i < 4; ++i)
    for (unsigned j = 0; j < i; ++j) most = std::max(most, distance(p[i], p[j]));
  return most;
}

// Three faces of a unit box: `below` and `above` are opposite and have no point in common; `beside` touches
// both.
struct OppositeFaces {
  Plc plc = complex_of(testing::box());
  Index below = none, above = none, beside = none;
  OppositeFaces() {
    for (Index p = 0; p < plc.patches.size(); ++p) {
      const Vector& n = plc.patches[p].normal;
      const double height = plc.patches[p].origin.z;
      (std::fabs(n.z) < 0.5 ? beside : height < 0.5 ? below : above) = p;
    }
  }
  ForcedEdges with(const std::array<Index, 4>& patches) const {
    std::vector<TetMesh::VertexFeature> features;
    for (const Index p : patches)
      features.push_back(p == none ? TetMesh::VertexFeature{} : TetMesh::VertexFeature{2, p});
    return ForcedEdges(plc, features, {}, {}, {}, -0.9);
  }
};

TEST(ForcedEdges, BetweenThreeCornersAndOneItIsTheHeight) {
  const OppositeFaces faces;
  std::mt19937 random(3);
  for (unsigned k = 0; k < 2000; ++k) {
    const Corners p = any_corners(random);
    const unsigned apex = k % 4;
    std::array<Index, 4> patches{faces.below, faces.below, faces.below, faces.below};
    patches[apex] = faces.above;
    std::array<Point, 3> base;
    for (unsigned i = 0, n = 0; i < 4; ++i)
      if (i != apex) base[n++] = p[i];
    const Vector normal = cross(base[1] - base[0], base[2] - base[0]);
    const double height = std::fabs(dot(p[apex] - base[0], normal)) / norm(normal);
    EXPECT_NEAR(faces.with(patches).narrowness(p, four), height / longest(p), 1e-12);
  }
}

TEST(ForcedEdges, BetweenTwoCornersAndTwoItIsTheDistanceOfLines) {
  const OppositeFaces faces;
  std::mt19937 random(4);
  for (unsigned k = 0; k < 300; ++k) {
    const Corners p = any_corners(random);
    const std::array<Index, 4> patches = k % 2 == 0
                                             ? std::array{faces.below, faces.above, faces.below, faces.above}
                                             : std::array{faces.above, faces.above, faces.below, faces.below};
    std::array<Point, 4> q = k % 2 == 0 ? std::array{p[0], p[2], p[1], p[3]} : p;
    // Finds the nearest points of two lines by alternating projections.
    double s = 0, t = 0;
    const Vector u = q[1] - q[0], v = q[3] - q[2];
    for (unsigned step = 0; step < 20000; ++step) {
      s = dot(q[2] + t * v - q[0], u) / squared_norm(u);
      t = dot(q[0] + s * u - q[2], v) / squared_norm(v);
    }
    const double between = distance(q[0] + s * u, q[2] + t * v);
    const double sine = norm(cross(u, v)) / (norm(u) * norm(v));
    if (sine < 0.05) continue;  // alternating would take too many steps
    EXPECT_NEAR(faces.with(patches).narrowness(p, four), between / longest(p), 1e-9);
  }
}

TEST(ForcedEdges, OfOthersItIsTheShortestForcedEdge) {
  const OppositeFaces faces;
  std::mt19937 random(5);
  for (unsigned k = 0; k < 500; ++k) {
    const Corners p = any_corners(random);
    const ForcedEdges one = faces.with({faces.below, faces.above, none, faces.beside});
    EXPECT_TRUE(one.forces(0, 1) && one.forces(1, 0));
    EXPECT_FALSE(one.forces(0, 2) || one.forces(0, 3) || one.forces(1, 3) || one.forces(2, 3));
    EXPECT_NEAR(one.narrowness(p, four), distance(p[0], p[1]) / longest(p), 1e-12);
    EXPECT_EQ(faces.with({faces.below, faces.beside, none, faces.below}).narrowness(p, four), 1);
    EXPECT_EQ(faces.with({none, none, none, none}).narrowness(p, four), 1);
  }
}

TEST(ForcedEdges, TwoSidesOfAPatchFaceOppositeWays) {
  const Plc plc = complex_of(testing::box());
  // A wall of one patch, one side above the other: triangles 0 1 2 and 3 5 4.
  const std::vector<Point> points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0.1}, {1, 0, 0.1}, {0, 1, 0.1}};
  const std::vector<TetMesh::VertexFeature> features(6, {2, 0});
  const ForcedEdges wall(plc, features, points, {{0, 1, 2}, {3, 5, 4}}, {0, 0}, -0.9);
  EXPECT_TRUE(wall.forces(0, 3) && wall.forces(1, 5));
  EXPECT_FALSE(wall.forces(0, 1) || wall.forces(3, 4));
  EXPECT_FALSE(wall.forces(0, 6)) << "a vertex that came later";
  const ForcedEdges alike(plc, features, points, {{0, 1, 2}, {3, 4, 5}}, {0, 0}, -0.9);
  EXPECT_FALSE(alike.forces(0, 3)) << "steps of one side";
}

TEST(ForcedEdges, ThinTetsMayBeAsSharpAsTheyLeaveThem) {
  const OppositeFaces faces;
  TetMesh mesh;
  mesh.points.resize(4);
  const auto forced =
      std::make_shared<const ForcedEdges>(faces.with({faces.below, faces.below, faces.below, faces.above}));
  const remeshing::ThinShape with(faces.plc, mesh, 8, 0, forced), without(faces.plc, mesh, 8, 0, nullptr);
  for (const double height : {0.3, 0.09, 0.01, 1e-4}) {
    const Corners prism{Point{0, 0, 0}, Point{1, 0, 0}, Point{0, 1, 0}, Point{0, 0, height}};
    EXPECT_TRUE(with.contains(prism, four)) << height;
    EXPECT_EQ(without.contains(prism, four), height > 0.1) << height;
    // The apex lies beside the triangle, in the plane of one of its sides: the angle is obtuse in any narrow
    // place.
    const Corners blunt{Point{0, 0, 0}, Point{1, 0, 0}, Point{0, 1, 0}, Point{0.6, 0.6, 0.1 * height}};
    EXPECT_FALSE(with.contains(blunt, four)) << height;
  }
}

TEST(ForcedEdges, OnlyVeryNarrowTetsAreJudgedByThem) {
  constexpr double deep = 0.03, good_enough = 2, smallest_angle = 8, radians = std::numbers::pi / 180;
  const OppositeFaces faces;
  TetMesh mesh;
  mesh.points.resize(4);
  const auto forced =
      std::make_shared<const ForcedEdges>(faces.with({faces.below, faces.below, faces.below, faces.above}));
  const remeshing::ThinShape shape(faces.plc, mesh, smallest_angle, 0, forced);
  unsigned judged_by_edges = 0, others = 0;
  for (double height = 0.07; height < 0.1; height += 1e-5) {
    const Corners p{Point{0, 0, 0}, Point{1, 0, 0}, Point{0, 1, 0}, Point{0, 0, height}};
    const remeshing::ExtremeCosines cosines = remeshing::extreme_cosines(p);
    const auto sine_of = [&](double degrees) {
      return std::sin((degrees + 2 * remeshing::ThinShape::rounding) * radians);
    };
    const double smallest = remeshing::squared_sine(cosines.smallest_angle),
                 edges_permit = sine_of(ForcedEdges::smallest_angle(forced->narrowness(p, four))),
                 usual = smallest / (sine_of(smallest_angle) * sine_of(smallest_angle));
    const bool by_edges = edges_permit < deep;
    ++(by_edges ? judged_by_edges : others);
    const double expected =
        by_edges && usual < good_enough
            ? std::max(usual, std::min(good_enough, smallest / (edges_permit * edges_permit)))
            : usual;
    EXPECT_DOUBLE_EQ(shape.squared_margins(cosines, p, four).of_smallest, expected) << height;
  }
  EXPECT_GT(std::min(judged_by_edges, others), 100U);
}

}  // namespace
}  // namespace collarmesh::forced_edges_test
