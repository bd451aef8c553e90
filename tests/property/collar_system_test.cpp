// Gap size against brute force, and the balls of the collar system against their definitions (paper,
// Definitions 2 and 7), on every acute family.
#include "collar/collar_system.h"
#include "collar/collar_placement.h"
#include "collar/gap_size.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "collarmesh/io/soup_io.h"
#include "support/acute_shapes.h"
#include "support/brute_force_gap.h"

namespace collarmesh::collar_system_test {
namespace {

namespace acute = testing::acute;
using testing::brute_force_gap;
using testing::features_of_vertex;
using testing::points_along;

constexpr double size = 0.3;
constexpr double crease_angle = 60;
constexpr double rounding = 1e-9;

std::vector<acute::Shape> shapes() {
  using namespace acute;
  std::vector<acute::Shape> all{wedge(60),
                                wedge(20),
                                wedge(1),
                                fan(8),
                                fan(40),
                                sectors(12),
                                pyramid(4, 30),
                                pyramid(5, 2),
                                star_prism(9, 0.4),
                                spiked_octahedron(1),
                                knife(5),
                                two_knives(20, 20),
                                comb(3, 10),
                                pyramid_on_a_box(60),
                                cubes_touching_in_an_edge(30),
                                cubes_touching_in_a_corner(),
                                facet_ending_inside(10),
                                segment_meeting_a_facet(3),
                                segment_near_a_crease(20, 0.03),
                                facet_near_a_crease(20, 0.03)};
  for (std::uint32_t seed = 1; seed <= 4; ++seed) {
    auto members = random_members(seed);
    std::move(members.begin(), members.end(), std::back_inserter(all));
  }
  return all;
}

std::vector<acute::Shape> curved_shapes() {
  std::vector<acute::Shape> shapes;
  for (const double half_angle : {45.0, 40.0, 30.0, 15.0, 5.0, 2.0})
    shapes.push_back(acute::round_cone(half_angle));
  for (const double angle : {60.0, 40.0, 20.0, 5.0}) shapes.push_back(acute::lens(angle));
  for (const double plane : {0.5, 0.6, 0.75, 0.9, 0.95}) shapes.push_back(acute::cut_torus(plane));
  for (const double width : {0.5, 0.2, 0.05}) shapes.push_back(acute::long_lens(40, width));
  for (const double angle : {40.0, 10.0}) shapes.push_back(acute::drop_bar(angle));
  for (const double angle : {45.0, 15.0}) shapes.push_back(acute::drop_cone(100, angle));
  return shapes;
}

struct Placed {
  explicit Placed(const acute::Shape& shape) : plc(build(shape)), creases(find_creases(plc, crease_angle)) {
    system = CollarSystem(plc, plc.points, creases, options(plc));
  }
  static CollarOptions options(const Plc& plc) {
    CollarOptions options;
    options.size = [](const Feature&, const Point&) { return size; };
    options.tolerance = SurfaceTolerance(1e-3 * plc.bounds.diagonal());
    return options;
  }
  static Plc build(const acute::Shape& shape) {
    PlcOptions options;
    options.feature_angle = shape.feature_angle;
    return build_plc(shape.soups, options);
  }
  double gap(const CollarBall& ball) const {
    return ball.dimension == 0
               ? brute_force_gap(plc, ball.centre, features_of_vertex(plc, ball.feature))
               : brute_force_gap(plc, ball.centre, {none, {ball.feature}, plc.curves[ball.feature].patches});
  }

  Plc plc;
  std::vector<Crease> creases;
  CollarSystem system;
};

// Expects equal gaps; both are infinite if every feature contains the point.
void expect_equal(double gap, double expected, const char* kind, Index feature) {
  if (std::isinf(expected)) {
    EXPECT_TRUE(std::isinf(gap)) << kind << " " << feature;
  } else {
    EXPECT_NEAR(gap, expected, rounding * expected) << kind << " " << feature;
  }
}

void expect_gap_sizes(const acute::Shape& shape) {
  SCOPED_TRACE(shape.name);
  const Plc plc = Placed::build(shape);
  const FeatureHierarchy features(plc, plc.points);
  GapInHierarchy gap(plc, features);
  for (Index v = 0; v < plc.vertices.size(); ++v) {
    const double expected =
        brute_force_gap(plc, plc.points[plc.vertices[v].point], features_of_vertex(plc, v));
    expect_equal(gap.at_vertex(v), expected, "vertex", v);
  }
  for (Index c = 0; c < plc.curves.size(); ++c)
    for (const Point& p : points_along(plc, c, plc.curves[c].straight ? 5 : 1)) {
      const double expected = brute_force_gap(plc, p, {none, {c}, plc.curves[c].patches});
      expect_equal(gap.on_curve(c, p), expected, "curve", c);
    }
}
// Checks every file of a corpus that is a complex: at every crease vertex, and in the middle of every segment
// of crease curves.
TEST(GapSize, EqualsBruteForceOnTheCorpus) {
  const char* corpus = std::getenv("COLLARMESH_CORPUS");
  if (corpus == nullptr || *corpus == '\0') GTEST_SKIP() << "COLLARMESH_CORPUS names no folder";
  std::size_t complexes = 0, places = 0;
  for (const auto& entry : std::filesystem::directory_iterator(corpus)) {
    const std::string path = entry.path().string();
    if (!io::is_soup_format(path)) continue;
    SCOPED_TRACE(path);
    Plc plc;
    try {
      const std::array<PolygonSoup, 1> soups{io::read_soup(path)};
      plc = build_plc(soups);
    } catch (const Error&) {
      continue;
    }
    ++complexes;
    const FeatureHierarchy features(plc, plc.points);
    GapInHierarchy gap(plc, features);
    std::vector<bool> vertex(plc.vertices.size(), false), curve(plc.curves.size(), false);
    for (const Crease& crease : find_creases(plc, crease_angle)) {
      if (crease.vertex != none) vertex[crease.vertex] = true;
      if (crease.curve == none) continue;
      curve[crease.curve] = true;
      for (const Index end : plc.curves[crease.curve].ends)
        if (end != none) vertex[end] = true;
    }
    for (Index v = 0; v < plc.vertices.size(); ++v) {
      if (!vertex[v]) continue;
      ++places;
      expect_equal(gap.at_vertex(v),
                   brute_force_gap(plc, plc.points[plc.vertices[v].point], features_of_vertex(plc, v)),
                   "vertex", v);
    }
    for (Index c = 0; c < plc.curves.size(); ++c) {
      if (!curve[c]) continue;
      for (const Point& p : points_along(plc, c, 1)) {
        ++places;
        expect_equal(gap.on_curve(c, p), brute_force_gap(plc, p, {none, {c}, plc.curves[c].patches}), "curve",
                     c);
      }
    }
  }
  EXPECT_GT(complexes, 10U);
  EXPECT_GT(places, 100U);
}

TEST(GapSize, EqualsBruteForceAtVerticesAndAlongCurves) {
  for (const acute::Shape& shape : shapes()) expect_gap_sizes(shape);
  for (const acute::Shape& shape : curved_shapes()) expect_gap_sizes(shape);
}

void expect_a_ball_at_every_crease(const Placed& placed) {
  EXPECT_EQ(placed.system.empty(), placed.creases.empty());
  for (const Crease& crease : placed.creases) {
    if (crease.curve != none) {
      EXPECT_TRUE(placed.system.is_crease_curve(crease.curve));
    }
    if (crease.vertex != none) {
      EXPECT_NE(placed.system.ball_at_vertex(crease.vertex), none);
    }
    EXPECT_NE(placed.system.ball_containing(crease.where), none) << describe(placed.plc, crease);
  }
}

void expect_small_radii(const Placed& placed) {
  for (const CollarBall& ball : placed.system.balls()) {
    EXPECT_LE(ball.radius, placed.gap(ball) / 3 * (1 + rounding));
    EXPECT_LE(ball.radius, size);
  }
}

// Returns whether two balls may meet because they lie on one crease curve.
bool on_one_crease(const Plc& plc, const CollarBall& a, const CollarBall& b) {
  if (a.dimension == 1 && b.dimension == 1) return a.feature == b.feature;
  if (a.dimension == b.dimension) return false;  // two vertices
  const CollarBall &at_vertex = a.dimension == 0 ? a : b, &on_curve = a.dimension == 0 ? b : a;
  return plc.vertex_on_curve(at_vertex.feature, on_curve.feature);
}

void expect_disjoint_creases(const Placed& placed) {
  const auto& balls = placed.system.balls();
  for (Index i = 0; i < balls.size(); ++i)
    for (Index j = i + 1; j < balls.size(); ++j)
      if (!on_one_crease(placed.plc, balls[i], balls[j])) {
        EXPECT_GT(distance(balls[i].centre, balls[j].centre), balls[i].radius + balls[j].radius)
            << "balls " << i << " and " << j;
      }
}

// Definition 7: a point on the surface of the union that is in two balls lies on their circle; no third ball
// contains a part of that circle.
void expect_no_third_ball_at_circles(const Placed& placed) {
  const auto& balls = placed.system.balls();
  for (const CollarLink& link : placed.system.links()) {
    const CollarBall &a = balls[link.balls[0]], &b = balls[link.balls[1]];
    const double d = distance(a.centre, b.centre);
    const double along = (d * d + a.radius * a.radius - b.radius * b.radius) / (2 * d);
    const Vector axis = (b.centre - a.centre) / d;
    const Point centre = a.centre + along * axis;
    ASSERT_LT(std::fabs(along), a.radius);
    const double radius = std::sqrt(a.radius * a.radius - along * along);
    for (Index k = 0; k < balls.size(); ++k) {
      if (k == link.balls[0] || k == link.balls[1]) continue;
      // The distance of the third centre from the circle.
      const Vector to_centre = balls[k].centre - centre;
      const double height = dot(to_centre, axis);
      const double off_axis = std::sqrt(std::max(0.0, squared_norm(to_centre) - height * height));
      EXPECT_GE(std::hypot(height, off_axis - radius), balls[k].radius) << "ball " << k;
    }
  }
}

void expect_deep_overlap(const Placed& placed) {
  const auto& balls = placed.system.balls();
  for (const CollarLink& link : placed.system.links()) {
    const CollarBall &a = balls[link.balls[0]], &b = balls[link.balls[1]];
    EXPECT_TRUE(placed.system.consecutive(link.balls[0], link.balls[1]));
    EXPECT_LE(squared_distance(a.centre, b.centre),
              (a.radius * a.radius + b.radius * b.radius) * (1 + rounding))
        << "balls " << link.balls[0] << " and " << link.balls[1];
  }
}

void expect_covered_creases(const Placed& placed) {
  for (Index c = 0; c < placed.plc.curves.size(); ++c) {
    if (!placed.system.is_crease_curve(c)) continue;
    for (const Index point : placed.plc.curves[c].points)
      EXPECT_NE(placed.system.ball_containing(placed.plc.points[point]), none) << "curve " << c;
    for (const Point& p : points_along(placed.plc, c, 200))
      EXPECT_NE(placed.system.ball_containing(p), none)
          << "curve " << c << " at " << p.x << ", " << p.y << ", " << p.z;
  }
}

void expect_keeps_definition(const Placed& placed) {
  expect_a_ball_at_every_crease(placed);
  expect_small_radii(placed);
  expect_disjoint_creases(placed);
  expect_no_third_ball_at_circles(placed);
  expect_deep_overlap(placed);
  expect_covered_creases(placed);
}

void expect_collar_system(const acute::Shape& shape) {
  SCOPED_TRACE(shape.name);
  expect_keeps_definition(Placed(shape));
}

TEST(CollarSystem, KeepsItsDefinition) {
  for (const acute::Shape& shape : shapes()) expect_collar_system(shape);
}

TEST(CollarSystem, KeepsItsDefinitionOnCurvedCreases) {
  for (const acute::Shape& shape : curved_shapes()) expect_collar_system(shape);
}

// On a rim of constant curvature the balls are alike: their radii differ only by the random shrinkage and by
// the effect of the polyline's corners.
TEST(CollarSystem, RadiiOnRoundRimsAreEven) {
  for (const acute::Shape& shape :
       {acute::round_cone(40), acute::lens(40), acute::lens(20), acute::cut_torus(0.6)}) {
    SCOPED_TRACE(shape.name);
    const Placed placed(shape);
    const auto [smallest, largest] =
        std::minmax_element(placed.system.balls().begin(), placed.system.balls().end(),
                            [](const CollarBall& a, const CollarBall& b) { return a.radius < b.radius; });
    EXPECT_LT(largest->radius, 1.5 * smallest->radius);
  }
}

// Compares queries of the hierarchy with a search over all balls.
void expect_brute_force_queries(const CollarSystem& system, unsigned places) {
  const auto& balls = system.balls();
  for (unsigned i = 0; i < places; ++i) {
    const double t = i * 0.618034, r = 0.05 * (i % 5);
    const Point p{2 * (t - std::floor(t)) - 1, std::sin(7.0 * i), 0.5 * std::cos(3.0 * i)};
    const auto inside = [&](const CollarBall& b) { return distance(p, b.centre) < b.radius; };
    const auto met = [&](const CollarBall& b) { return distance(p, b.centre) <= b.radius + r; };
    EXPECT_EQ(system.ball_containing(p) != none, std::any_of(balls.begin(), balls.end(), inside));
    std::vector<Index> found, expected;
    const auto all_met = static_cast<std::size_t>(std::count_if(balls.begin(), balls.end(), met));
    for (const std::size_t most : {std::size_t{1}, std::size_t{3}, balls.size() + 1}) {
      system.balls_meeting(p, r, most, found);
      EXPECT_EQ(found.size(), std::min(most, all_met));
      for (const Index b : found) EXPECT_TRUE(met(balls[b]));
    }
    const Point q = balls.empty() ? Point{} : balls[i % balls.size()].centre;
    system.balls_on_segment(p, q, found);
    for (Index b = 0; b < balls.size(); ++b)
      if (testing::distance_to_segment(balls[b].centre, p, q) < balls[b].radius) expected.push_back(b);
    std::sort(found.begin(), found.end());
    EXPECT_EQ(found, expected);
  }
}

TEST(CollarSystem, QueriesEqualBruteForce) {
  for (const acute::Shape& shape : {acute::fan(8), acute::star_prism(9, 0.4)})
    expect_brute_force_queries(Placed(shape).system, 2000);
}

// Each crease gets its balls at another time, and new balls are found at once.
TEST(CollarSystem, QueriesEqualBruteForceWhileBallsCome) {
  for (const acute::Shape& shape : {acute::fan(8), acute::star_prism(9, 0.4), acute::lens(40)}) {
    SCOPED_TRACE(shape.name);
    const Plc plc = Placed::build(shape);
    CollarSystem system(plc, plc.points, find_creases(plc, crease_angle));
    GapInHierarchy gap(plc, system.features());
    CollarPlacement placement(plc, plc.points, gap, Placed::options(plc), system);
    expect_brute_force_queries(system, 3);
    for (const Index vertex : system.crease_vertices()) {
      placement.place_at_vertex(vertex);
      expect_brute_force_queries(system, 20);
    }
    for (Index c = 0; c < plc.curves.size(); ++c) {
      if (!system.is_crease_curve(c)) continue;
      placement.place_on_curve(c);
      expect_brute_force_queries(system, 20);
    }
    system.complete();
    expect_brute_force_queries(system, 200);
    EXPECT_EQ(system.balls().size(), Placed(shape).system.balls().size());
  }
}

// Mesh vertices on a crease that have room for a ball become its centres, and the balls still satisfy the
// definition.
TEST(CollarSystem, CentresBallsOnVerticesOfTheirCurve) {
  for (const acute::Shape& shape : {acute::lens(40), acute::cut_torus(0.5), acute::round_cone(30)}) {
    SCOPED_TRACE(shape.name);
    Placed placed(shape);
    CollarSystem system(placed.plc, placed.plc.points, placed.creases);
    GapInHierarchy gap(placed.plc, system.features());
    CollarPlacement placement(placed.plc, placed.plc.points, gap, Placed::options(placed.plc), system);
    const CurvePaths paths(placed.plc, placed.plc.points);
    for (const Index vertex : system.crease_vertices()) placement.place_at_vertex(vertex);
    for (Index c = 0; c < placed.plc.curves.size(); ++c) {
      if (!system.is_crease_curve(c)) continue;
      std::vector<PlaceOnCurve> vertices;
      for (const double share : {0.31, 0.3101, 0.72})
        vertices.push_back({share * paths.length(c), paths.point(c, share * paths.length(c))});
      placement.place_on_curve(c, vertices);
      const auto is_centre = [&](const PlaceOnCurve& place) {
        return std::any_of(system.balls().begin(), system.balls().end(),
                           [&](const CollarBall& ball) { return ball.centre == place.point; });
      };
      EXPECT_TRUE(is_centre(vertices[0]));
      EXPECT_FALSE(is_centre(vertices[1])) << "it is too near to the first one";
      EXPECT_TRUE(is_centre(vertices[2]));
    }
    system.complete();
    placed.system = std::move(system);
    expect_keeps_definition(placed);
  }
}

}  // namespace
}  // namespace collarmesh::collar_system_test
