// The cost of a refinement by counting, not by clocks: what the paper bounds by the logarithm of the spread,
// or by constants, stays below them while the input, or its spread, grows.
#include <gtest/gtest.h>

#include <cmath>

#include "support/acute_shapes.h"
#include "support/meshing.h"
#include "support/shapes.h"

namespace collarmesh {
namespace {

MeshStatistics counted(const std::vector<PolygonSoup>& soups, MeshOptions options) {
  options.count_work = true;
  const MeshResult result = generate(build_plc(soups), options);
  EXPECT_EQ(result.status, MeshStatus::complete) << result.message;
  return result.statistics;
}

double moves_per_object(const WorkCounts& counts) {
  return static_cast<double>(counts.relocated) / static_cast<double>(counts.located);
}

// Aspect ratios are those of a radius-edge bound of 2; the largest seen is 10.
void expect_well_spaced(const WorkCounts& counts) {
  EXPECT_GT(counts.smallest_aspect, 1);
  EXPECT_LT(counts.largest_aspect, 14);
}

// The number of features is fixed.
TEST(WorkCounts, GrowWithTheLogarithmOfTheSpread) {
  for (const int exponent : {2, 6, 12, 20, 28}) {
    SCOPED_TRACE(exponent);
    const MeshStatistics s =
        counted({testing::box_with_small_facet(std::ldexp(1.0, -exponent))}, testing::with_size(0.5));
    EXPECT_LE(moves_per_object(s.counts), 1);
    EXPECT_LE(s.counts.largest_degree, 30U);
    EXPECT_LE(s.counts.largest_cavity, 45U);
    EXPECT_LE(s.vertices_inserted, 60U + 12U * static_cast<unsigned>(exponent));
    expect_well_spaced(s.counts);
  }
}

// Points on two lines: so do number and spread, one as the other.
TEST(WorkCounts, OfAnObjectGrowNoFasterThanTheLogarithmOfTheirNumber) {
  for (const unsigned points : {10U, 40U, 160U, 640U}) {
    SCOPED_TRACE(points);
    const MeshStatistics s = counted({testing::box_with_skew_lines(points)}, testing::with_size(0.5));
    EXPECT_LE(moves_per_object(s.counts), 0.8 * std::log2(2 * points));
    EXPECT_LE(s.counts.largest_degree, 30U);
    EXPECT_LE(s.counts.largest_cavity, 50U);
    expect_well_spaced(s.counts);
  }
}

// The edges of a cube are made ever finer in a mesh that has quality.
TEST(WorkCounts, OfFineCurvesAreThoseOfCoarseOnes) {
  const PolygonSoup cube = testing::box();
  const Plc plc = build_plc({&cube, 1});
  for (const int exponent : {4, 6, 8}) {
    SCOPED_TRACE(exponent);
    MeshOptions options = testing::with_size(0.5);
    for (const Plc::Curve& curve : plc.curves) options.curve_size[curve.tag] = std::ldexp(1.0, -exponent);
    const MeshStatistics s = counted({cube}, options);
    EXPECT_LE(s.counts.relocated, 60U);
    EXPECT_LE(s.counts.largest_degree, 60U);
    EXPECT_LE(s.counts.largest_cavity, 110U);
    expect_well_spaced(s.counts);
  }
}

// Collars up front and in the pass, which asks for the gap size in the mesh.
TEST(WorkCounts, OfAGridOfWedgesAreThoseOfOne) {
  const PolygonSoup wedge = testing::acute::wedge(20).soups[0];
  for (const unsigned n : {1U, 2U, 4U})
    for (const CollarCreation creation : {CollarCreation::up_front, CollarCreation::in_pass}) {
      SCOPED_TRACE(n);
      PolygonSoup grid = wedge;
      for (unsigned i = 1; i < n * n; ++i) {
        const unsigned row = i / n;
        grid = testing::joined(grid, testing::translated(wedge, {1.5 * (i % n), 1.5 * row, 0}));
      }
      MeshOptions options = testing::with_size(0.3);
      options.collar_creation = creation;
      const MeshStatistics s = counted({grid}, options);
      EXPECT_LE(moves_per_object(s.counts), 0.6 * std::log2(s.counts.located));
      EXPECT_LE(s.counts.largest_degree, 90U);
      EXPECT_LE(s.counts.largest_cavity, 200U);
      EXPECT_LE(s.counts.ripped_out, 4U * n * n);
      if (creation == CollarCreation::up_front) continue;
      EXPECT_GT(s.counts.gap_queries, 10U * n * n);
      EXPECT_LE(s.counts.gap_cells, 12U * s.counts.gap_queries);
    }
}

TEST(WorkCounts, AreMadeOnRequestOnly) {
  const MeshStatistics s =
      generate(build_plc(std::vector{testing::box()}), testing::with_size(0.5)).statistics;
  EXPECT_EQ(s.counts.located, 0U);
  EXPECT_EQ(s.counts.largest_degree, 0U);
}

}  // namespace
}  // namespace collarmesh
