// The gap size found by exploring the mesh (paper, Procedure 4), compared with brute force throughout the
// refinement: the answer must not depend on the mesh's fineness.
#include "refine/gap_explorer.h"

#include <gtest/gtest.h>

#include <cmath>

#include "collarmesh/plc_builder.h"
#include "refine/refinement.h"
#include "support/acute_shapes.h"
#include "support/brute_force_gap.h"
#include "support/meshing.h"

namespace collarmesh::gap_explorer_test {
namespace {

namespace acute = testing::acute;

constexpr double size = 0.3;
constexpr std::size_t most_places_per_curve = 10;

struct Place {
  Feature at;   // a vertex or curve
  Point point;  // in the frame of the refinement
  double gap;
};

std::vector<Place> places_of(const Plc& plc) {
  std::vector<Place> places;
  for (Index v = 0; v < plc.vertices.size(); ++v) {
    const Point& p = plc.points[plc.vertices[v].point];
    places.push_back({{0, v}, p, testing::brute_force_gap(plc, p, testing::features_of_vertex(plc, v))});
  }
  const Frame frame(plc.bounds);
  for (Index c = 0; c < plc.curves.size(); ++c) {
    const std::vector<Point> points = testing::points_along(plc, c, plc.curves[c].straight ? 3 : 1);
    for (std::size_t i = 0; i < points.size(); i += 1 + points.size() / most_places_per_curve) {
      const double gap = testing::brute_force_gap(plc, points[i], {none, {c}, plc.curves[c].patches});
      places.push_back({{1, c}, frame.inside(points[i]), gap});
    }
  }
  return places;
}

// Returns whether to compare after this quality phase: after every phase early on, later ever less often.
bool looks_at(std::size_t phase) { return phase <= 8 || (phase & (phase - 1)) == 0; }

void expect_brute_force_gaps(const acute::Shape& shape) {
  SCOPED_TRACE(shape.name);
  PlcOptions complex;
  complex.feature_angle = shape.feature_angle;
  const Plc plc = build_plc(shape.soups, complex);
  const std::vector<Place> places = places_of(plc);
  const Execution execution;
  Refinement refinement(plc, testing::with_size(size), execution);
  std::size_t phases = 0;
  refinement.observe_quality_phases([&] {
    if (!looks_at(++phases)) return;
    GapExplorer& explorer = refinement.gap_size();
    for (const Place& place : places) {
      const auto gap = [&](double bound) {
        return place.at.dimension == 0 ? explorer.at_vertex(place.at.index, bound)
                                       : explorer.on_curve(place.at.index, place.point, bound);
      };
      const double found = gap(INFINITY);
      if (std::isinf(place.gap))
        EXPECT_TRUE(std::isinf(found));
      else
        EXPECT_NEAR(found, place.gap, 1e-9 * place.gap);
      const double bound = 0.7 * std::min(1.0, place.gap);
      EXPECT_NEAR(gap(bound), bound, 1e-12);
    }
  });
  EXPECT_EQ(refinement.run(), MeshStatus::complete);
  EXPECT_GT(phases, 8U);
}

TEST(GapExplorer, EqualsBruteForceOnPlanarShapes) {
  using namespace acute;
  for (const Shape& shape :
       {wedge(60), wedge(2), wedge_on_a_large_one(20, 1e-4), fan(8), sectors(8), pyramid(4, 30),
        pyramid(5, 2), star_prism(9, 0.4), spiked_octahedron(1), knife(5), comb(3, 30), two_knives(20, 20),
        pyramid_on_a_box(60), wedges_touching_in_an_edge(30, 5), cubes_touching_in_a_corner(),
        pyramids_tip_to_tip(4, 20), facet_ending_inside(10)})
    expect_brute_force_gaps(shape);
}

// Features on no patch are found from the cells, too.
TEST(GapExplorer, EqualsBruteForceBesideLoneSegments) {
  using namespace acute;
  for (const Shape& shape :
       {segment_meeting_a_facet(3), segments_from_a_point(12, 12), segment_near_a_crease(20, 0.03),
        segment_near_a_crease(20, 0.03, true), facet_near_a_crease(20, 0.03)})
    expect_brute_force_gaps(shape);
}

TEST(GapExplorer, EqualsBruteForceOnCurvedShapes) {
  using namespace acute;
  for (const Shape& shape : {round_cone(30), lens(40), cut_torus(0.5), drop_bar(20), drop_cone(75, 45)})
    expect_brute_force_gaps(shape);
}

TEST(GapExplorer, EqualsBruteForceOnRandomMembers) {
  for (const acute::Shape& shape : acute::random_members(5)) expect_brute_force_gaps(shape);
}

}  // namespace
}  // namespace collarmesh::gap_explorer_test
