// Collars created in the pass (paper, section 3.2) and up front: the same guarantees. Also checks what the
// paper proves about the mesh at the moment of creation.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "collarmesh/plc_builder.h"
#include "refine/refinement.h"
#include "support/acute_shapes.h"
#include "support/brute_force_gap.h"
#include "support/meshing.h"

namespace collarmesh::collar_creation_test {
namespace {

namespace acute = testing::acute;

constexpr double size = 0.3, edge = Sizing::edge_per_size * size;

MeshOptions with(CollarCreation creation) {
  MeshOptions options = testing::with_size(size);
  options.collar_creation = creation;
  return options;
}
constexpr std::array both{CollarCreation::in_pass, CollarCreation::up_front};

std::vector<acute::Shape> shapes() {
  using namespace acute;
  return {wedge(60),
          wedge(20),
          wedge(2),
          wedge_on_a_large_one(20, 1e-4),
          fan(8),
          sectors(8),
          pyramid(4, 30),
          pyramid(5, 2),
          star_prism(9, 0.4),
          spiked_octahedron(1),
          knife(5),
          two_knives(20, 20),
          comb(3, 10),
          pyramid_on_a_box(20),
          wedges_touching_in_an_edge(30, 5),
          cubes_touching_in_a_corner(),
          pyramids_tip_to_tip(4, 20),
          facet_ending_inside(10),
          segment_meeting_a_facet(3),
          segments_from_a_point(12, 12),
          segment_near_a_crease(20, 0.03, true),
          facet_near_a_crease(20, 0.03),
          turned(random_pyramid(7), 7),
          round_cone(30),
          lens(40),
          cut_torus(0.5),
          long_lens(40, 0.2),
          drop_bar(20),
          drop_cone(75, 45)};
}

TEST(CollarCreation, KeepsAllGuarantees) {
  for (const acute::Shape& shape : shapes())
    for (const CollarCreation creation : both) {
      SCOPED_TRACE(shape.name);
      EXPECT_EQ(testing::faults(testing::mesh_of(shape.soups, with(creation), shape.feature_angle)), "");
    }
}

TEST(CollarCreation, RandomMembersOfEveryFamily) {
  for (const acute::Shape& shape : acute::random_members(3))
    for (const CollarCreation creation : both) {
      SCOPED_TRACE(shape.name);
      EXPECT_EQ(testing::faults(testing::mesh_of(shape.soups, with(creation), 0)), "");
    }
}

bool contains_crease(const Plc& plc, const Feature& feature, const CollarBall& ball) {
  return feature.dimension == 3 || contains(plc, feature, {ball.dimension, ball.feature});
}

// Returns epsilon_0 for theta and the largest radius-edge ratio that the run allows (paper, proof of Lemma
// 8).
double epsilon_0(const MeshOptions& options) {
  const double epsilon_1 = 1 / (4 * std::max(options.exterior_radius_edge, options.bounds.radius_edge));
  return options.theta * epsilon_1 / (options.theta + 1);
}

// The gap size of every ball equals the one found by brute force. When a gap ball is created, no vertex of
// another feature is in it, and the mesh is not much finer than the gap at the ball's centre (paper, Lemma
// 2).
void expect_created_in_time(const acute::Shape& shape) {
  SCOPED_TRACE(shape.name);
  PlcOptions complex;
  complex.feature_angle = shape.feature_angle;
  const Plc plc = build_plc(shape.soups, complex);
  const Frame frame(plc.bounds);
  const MeshOptions options = with(CollarCreation::in_pass);
  const Execution execution;
  Refinement refinement(plc, options, execution);
  std::vector<bool> has_ball(plc.vertices.size(), false);
  refinement.observe_collars([&](const CollarBall& ball) {
    const Point centre = frame.outside(ball.centre);
    const bool at_vertex = ball.dimension == 0;
    const double gap =
        at_vertex
            ? testing::brute_force_gap(plc, centre, testing::features_of_vertex(plc, ball.feature))
            : testing::brute_force_gap(plc, centre, {none, {ball.feature}, plc.curves[ball.feature].patches});
    EXPECT_LE(ball.radius, std::min(gap / 3, edge) * (1 + 1e-9));
    if (at_vertex && shape.feature_angle == 0) {
      EXPECT_GE(ball.radius, 0.98 * std::min(gap / 3, edge));
    }
    if (at_vertex) has_ball[ball.feature] = true;
    const Triangulation& mesh = refinement.triangulation();
    for (Index v = 8; v < mesh.vertex_count(); ++v) {
      const double d = distance(mesh.point(v), ball.centre);
      if (!contains_crease(plc, refinement.feature_of(v), ball)) {
        EXPECT_GE(d, gap * (1 - 1e-9));
      }
      // Leaves out the vertex at the ball's centre, which is there up to rounding. Radii along round rims are
      // far smaller than the gap.
      if (d > 1e-12 * ball.radius) {
        EXPECT_GT(d, epsilon_0(options) * (at_vertex ? gap : 3 * ball.radius));
      }
    }
  });
  EXPECT_EQ(refinement.run(), MeshStatus::complete);
  for (const Crease& crease : find_creases(plc, options.bounds.crease_angle))
    if (crease.vertex != none) {
      EXPECT_TRUE(has_ball[crease.vertex]);
    }
}

TEST(CollarCreation, ComesNeitherTooEarlyNorTooLate) {
  for (const acute::Shape& shape : shapes()) expect_created_in_time(shape);
}

}  // namespace
}  // namespace collarmesh::collar_creation_test
