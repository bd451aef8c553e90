// The invariant of Sparse Voronoi Refinement during the run (paper, section 3.1): whenever all skinny cells
// are destroyed, before anything else is inserted, the cells outside collars have a bounded radius-edge
// ratio.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "collarmesh/plc_builder.h"
#include "refine/refinement.h"
#include "support/acute_shapes.h"
#include "support/meshing.h"
#include "support/shapes.h"

namespace collarmesh::well_spaced_test {
namespace {

double radius_edge(const Triangulation& mesh, Index cell) {
  const auto& v = mesh.corners(cell);
  double shortest = INFINITY;
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < i; ++j)
      shortest = std::min(shortest, squared_distance(mesh.point(v[i]), mesh.point(v[j])));
  return std::sqrt(mesh.squared_radius(cell) / shortest);
}

Box bounds(const Triangulation& mesh) {
  Box box;
  for (Index v = 0; v < 8; ++v) box.add(mesh.point(v));
  return box;
}

// Centres outside the box cannot be inserted.
bool holds(const Box& box, const Point& p) {
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (!(p[axis] > box.min[axis] && p[axis] < box.max[axis])) return false;
  return true;
}

// Returns the number of vertices that were inserted in blocks.
std::size_t expect_well_spaced_all_along(const std::vector<PolygonSoup>& soups, double size,
                                         double feature_angle) {
  PlcOptions complex;
  complex.feature_angle = feature_angle;
  const Plc plc = build_plc(soups, complex);
  const MeshOptions options = testing::with_size(size);
  const double bound = std::max(options.bounds.radius_edge, options.exterior_radius_edge) * (1 + 1e-9);
  const Execution execution;
  Refinement refinement(plc, options, execution);
  std::size_t phases = 0, cells = 0, worse = 0;
  refinement.observe_quality_phases([&] {
    // Checks all phases early on, later ever fewer, because each check visits the whole mesh.
    const Triangulation& mesh = refinement.triangulation();
    if (++phases > 64 && phases % (37 + mesh.vertex_count() / 64) != 0) return;
    const Box box = bounds(mesh);
    for (Index cell = 0; cell < mesh.cell_capacity(); ++cell) {
      if (!mesh.alive(cell) || refinement.in_collar(cell) || !holds(box, mesh.circumcentre(cell))) continue;
      ++cells;
      worse += radius_edge(mesh, cell) > bound ? 1 : 0;
    }
  });
  EXPECT_EQ(refinement.run(), MeshStatus::complete);
  EXPECT_GT(phases, 50U);
  EXPECT_GT(cells, 1000U);
  EXPECT_EQ(worse, 0U) << "of " << cells << " in " << phases << " phases";
  return refinement.statistics().vertices_in_blocks;
}

TEST(WellSpaced, AfterEachQualityPhase) {
  expect_well_spaced_all_along({testing::l_shape()}, 0.2, 0);
  expect_well_spaced_all_along({testing::icosphere(1, 12)}, 0.3, 30);
}
// Many cells and triangles are destroyed at once: the skinny cells that remain between blocks come before
// anything else.
TEST(WellSpaced, BetweenRoundsOfBlocks) {
  EXPECT_GT(expect_well_spaced_all_along({testing::l_shape()}, 0.06, 0), 5000U);
  EXPECT_GT(expect_well_spaced_all_along({testing::icosphere(1, 12)}, 0.075, 30), 3000U);
  EXPECT_GT(expect_well_spaced_all_along(testing::acute::wedge(20).soups, 0.035, 0), 1000U);
}
TEST(WellSpaced, AfterEachQualityPhaseBesideCollars) {
  expect_well_spaced_all_along(testing::acute::wedge(20).soups, 0.3, 0);
  expect_well_spaced_all_along(testing::acute::fan(8).soups, 0.3, 0);
  expect_well_spaced_all_along(testing::acute::pyramid(4, 30).soups, 0.3, 0);
}

}  // namespace
}  // namespace collarmesh::well_spaced_test
