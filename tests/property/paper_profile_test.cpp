// The options of --profile paper, which meet every hypothesis of the paper's proofs: runs end, their
// certificates hold, and during the run the mesh has the properties that the proofs claim.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "collarmesh/error.h"
#include "collarmesh/options.h"
#include "collarmesh/pipeline.h"
#include "refine/refinement.h"
#include "support/acute_shapes.h"
#include "support/meshing.h"
#include "support/polylines.h"
#include "support/shapes.h"

namespace collarmesh::paper_profile_test {
namespace {

namespace acute = testing::acute;
namespace polylines = testing::polylines;
using acute::Shape;

MeshOptions paper() {
  MeshOptions options = testing::with_size(0, 200'000);
  options.profile = Profile::paper;
  options.count_work = true;
  return with_profile(options);
}

PolygonSoup grid_of_wedges(unsigned n) {
  const PolygonSoup wedge = acute::wedge(20).soups[0];
  PolygonSoup grid = wedge;
  for (unsigned i = 1; i < n * n; ++i) {
    const unsigned row = i / n;
    grid = testing::joined(grid, testing::translated(wedge, {1.5 * (i % n), 1.5 * row, 0}));
  }
  return grid;
}

std::vector<Shape> acute_shapes() {
  std::vector<Shape> shapes{acute::wedge(80),
                            acute::wedge(37),
                            acute::wedge(4),
                            acute::fan(7),
                            acute::fan(16),
                            acute::star_prism(5, 0.4),
                            acute::spiked_octahedron(1),
                            acute::pyramid(4, 30),
                            acute::knife(10),
                            acute::two_knives(10, 20),
                            acute::comb(3, 20),
                            acute::facet_ending_inside(20),
                            acute::segment_meeting_a_facet(20),
                            acute::segments_from_a_point(12, 12),
                            acute::segment_near_a_crease(20, 0.1),
                            acute::cubes_touching_in_an_edge(10),
                            acute::cubes_touching_in_a_corner(),
                            acute::pyramid_on_a_box(20),
                            acute::wedge_on_a_large_one(20, 1e-3)};
  for (const unsigned n : {2U, 3U}) shapes.push_back({"wedges", {grid_of_wedges(n)}, 0, 0});
  return shapes;
}

std::vector<Shape> other_shapes() {
  return {{"a box", {testing::box()}, 0, 0},
          {"points on skew lines", {testing::box_with_skew_lines(40)}, 0, 0},
          {"a small facet", {testing::box_with_small_facet(1e-4)}, 0, 0},
          polylines::skew_zigzags(60),
          polylines::skew_zigzags(60, 45),
          polylines::helices(60),
          polylines::random_walk(60),
          polylines::graph(40),
          polylines::outlines(60),
          polylines::star(12),
          polylines::shrinking_spiral(40, 1e-3)};
}

void expect_ends_and_certifies(const Shape& shape) {
  SCOPED_TRACE(shape.name);
  const testing::Meshed made = testing::mesh_of(shape.soups, paper(), 0);
  EXPECT_EQ(testing::faults(made), "");
  EXPECT_GT(made.result.mesh.tets.size(), 0U);
}

TEST(PaperProfile, EndsAndCertifiesAcuteFamilies) {
  for (const Shape& shape : acute_shapes()) expect_ends_and_certifies(shape);
}

TEST(PaperProfile, EndsAndCertifiesPointsPolylinesAndBoxes) {
  for (const Shape& shape : other_shapes()) expect_ends_and_certifies(shape);
}

double radius_edge(const Triangulation& mesh, Index cell) {
  const auto& v = mesh.corners(cell);
  double shortest = INFINITY;
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < i; ++j)
      shortest = std::min(shortest, squared_distance(mesh.point(v[i]), mesh.point(v[j])));
  return std::sqrt(mesh.squared_radius(cell) / shortest);
}

bool holds(const Triangulation& mesh, const Point& p) {
  Box box;
  for (Index v = 0; v < 8; ++v) box.add(mesh.point(v));
  return p.x > box.min.x && p.y > box.min.y && p.z > box.min.z && p.x < box.max.x && p.y < box.max.y &&
         p.z < box.max.z;
}

// One bound on the ratio holds whenever no skinny cell is left, also outside the regions and in collars.
TEST(PaperProfile, IsWellSpacedEverywhere) {
  for (const Shape& shape : {acute::wedge(20), acute::fan(8), acute::pyramid(4, 30)}) {
    SCOPED_TRACE(shape.name);
    PlcOptions complex;
    complex.feature_angle = 0;
    const Plc plc = build_plc(shape.soups, complex);
    const MeshOptions options = paper();
    const Execution execution;
    Refinement refinement(plc, options, execution);
    const double bound = options.bounds.radius_edge * (1 + 1e-9);
    std::size_t phases = 0, in_collars = 0, worse = 0;
    refinement.observe_quality_phases([&] {
      if (++phases % 16 != 0) return;
      const Triangulation& mesh = refinement.triangulation();
      for (Index cell = 0; cell < mesh.cell_capacity(); ++cell) {
        if (!mesh.alive(cell) || !holds(mesh, mesh.circumcentre(cell))) continue;
        in_collars += refinement.in_collar(cell) ? 1 : 0;
        worse += radius_edge(mesh, cell) > bound ? 1 : 0;
      }
    });
    EXPECT_EQ(refinement.run(), MeshStatus::complete);
    EXPECT_GT(in_collars, 1000U);
    EXPECT_EQ(worse, 0U);
  }
}

// The distance to the nearest vertex divided by that to the second nearest one, when a vertex was inserted
// (paper, section 3.1). Points that split a curve are medial only in the curve's own mesh.
TEST(PaperProfile, InsertsWhatIsMedial) {
  for (const Shape& shape : {acute::wedge(20), acute::wedge(4), polylines::random_walk(60)}) {
    SCOPED_TRACE(shape.name);
    PlcOptions complex;
    complex.feature_angle = 0;
    const Plc plc = build_plc(shape.soups, complex);
    const MeshOptions options = paper();
    const Execution execution;
    Refinement refinement(plc, options, execution);
    ASSERT_EQ(refinement.run(), MeshStatus::complete);
    const Triangulation& mesh = refinement.triangulation();
    const double theta_0 = options.theta / (options.theta + 1) * (1 - 1e-9);
    std::size_t seen = 0;
    for (Index v = 8; v < mesh.vertex_count(); ++v) {
      if (refinement.feature_of(v).dimension == 1) continue;
      double nearest = INFINITY, second = INFINITY;
      for (Index u = 0; u < v; ++u) {
        const double d = distance(mesh.point(u), mesh.point(v));
        second = std::min(second, std::max(d, nearest));
        nearest = std::min(nearest, d);
      }
      ++seen;
      EXPECT_GE(nearest, theta_0 * second) << v;
    }
    EXPECT_GT(seen, 100U);
  }
}

TEST(PaperProfile, HasNoPairsBlocksAndSizes) {
  const testing::Meshed made = testing::mesh_of(testing::box(), paper(), 0);
  EXPECT_EQ(made.result.statistics.vertices_in_blocks, 0U);
  EXPECT_LT(made.result.mesh.points.size(), 40U);
}

// The pipeline applies the profile's options by itself, and judges by the profile's bounds.
TEST(PaperProfile, IsThePipelines) {
  PipelineOptions options;
  options.mesh.profile = Profile::paper;
  const PolygonSoup wedge = acute::wedge(60).soups[0];
  const SoupPipelineResult made = run_pipeline({&wedge, 1}, options);
  EXPECT_TRUE(made.guarantees_hold()) << made.missed();
  EXPECT_FALSE(made.coarsening);
  EXPECT_GT(made.check.collar_tets, 0U) << "below 90 degrees, features form a crease";
  EXPECT_EQ(made.check.thin_tets, 0U);
  EXPECT_EQ(run_pipeline({&wedge, 1}).check.collar_tets, 0U)
      << "60 degrees are a crease in this profile only";
}

}  // namespace
}  // namespace collarmesh::paper_profile_test
