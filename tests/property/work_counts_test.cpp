// The cost of a refinement, measured by counts instead of clocks: quantities that the paper bounds by the
// logarithm of the spread, or by constants, stay bounded while the input or its spread grows.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "support/acute_shapes.h"
#include "support/expected_counts.h"
#include "support/meshing.h"
#include "support/polylines.h"
#include "support/shapes.h"

namespace collarmesh::work_counts_test {
namespace {

namespace polylines = testing::polylines;
using polylines::Shape;

MeshStatistics counted(const std::vector<PolygonSoup>& soups, MeshOptions options) {
  options.count_work = true;
  PlcOptions complex;
  complex.feature_angle = 0;
  const MeshResult result = generate(build_plc(soups, complex), options);
  EXPECT_EQ(result.status, MeshStatus::complete) << result.message;
  return result.statistics;
}

double moves_per_object(const WorkCounts& counts) {
  return static_cast<double>(counts.relocated) / static_cast<double>(counts.located);
}

double looks_per_object(const WorkCounts& counts) {
  return static_cast<double>(counts.looks) / static_cast<double>(counts.located);
}

/// The maximum of each count over the members of a family. The destructor compares the maxima with the table
/// of expected counts. Each count of the family in the table must have been added.
class LargestCounts {
 public:
  explicit LargestCounts(std::string family) : family_(std::move(family)) {}
  LargestCounts(const LargestCounts&) = delete;
  LargestCounts& operator=(const LargestCounts&) = delete;
  ~LargestCounts() {
    const std::string prefix = "work/" + family_ + "/";
    for (const auto& [counted, largest] : largest_) testing::expect_count(prefix + counted, largest);
    for (const std::string& key : testing::expected_keys(prefix))
      EXPECT_TRUE(largest_.contains(key.substr(prefix.size()))) << key << " was not counted";
  }
  template <class Number>
  void add(const std::string& counted, Number count) {
    double& largest = largest_[counted];
    largest = std::max(largest, static_cast<double>(count));
  }

 private:
  std::string family_;
  std::map<std::string, double> largest_;
};

// Adds counts that are bounded because the bound on radius-edge ratios makes vertices well spaced.
void add_well_spaced(LargestCounts& largest, const WorkCounts& counts) {
  EXPECT_GT(counts.smallest_aspect, 1);
  largest.add("aspect ratio", counts.largest_aspect);
  largest.add("degree", counts.largest_degree);
  largest.add("cavity", counts.largest_cavity);
}

// The number of features is fixed here.
TEST(WorkCounts, GrowWithTheLogarithmOfTheSpread) {
  LargestCounts largest("small facet");
  double vertices = 0;
  int halvings = 0;
  for (const int exponent : {2, 6, 12, 20, 28}) {
    SCOPED_TRACE(exponent);
    const MeshStatistics s =
        counted({testing::box_with_small_facet(std::ldexp(1.0, -exponent))}, testing::with_size(0.5));
    EXPECT_LE(moves_per_object(s.counts), 1);
    const auto inserted = static_cast<double>(s.vertices_inserted);
    if (halvings > 0) largest.add("vertices for each halving", (inserted - vertices) / (exponent - halvings));
    vertices = inserted;
    halvings = exponent;
    add_well_spaced(largest, s.counts);
  }
}

// Points on two lines: their number and their spread grow together.
TEST(WorkCounts, OfAnObjectGrowNoFasterThanTheLogarithmOfTheirNumber) {
  LargestCounts largest("skew lines");
  for (const unsigned points : {10U, 40U, 160U, 640U}) {
    SCOPED_TRACE(points);
    const MeshStatistics s = counted({testing::box_with_skew_lines(points)}, testing::with_size(0.5));
    EXPECT_LE(moves_per_object(s.counts), 0.8 * std::log2(2 * points));
    add_well_spaced(largest, s.counts);
  }
}

// The edges of a cube are refined in a mesh that has quality.
TEST(WorkCounts, OfFineCurvesAreThoseOfCoarseOnes) {
  const PolygonSoup cube = testing::box();
  const Plc plc = build_plc({&cube, 1});
  LargestCounts largest("fine curves");
  for (const int exponent : {4, 6, 8}) {
    SCOPED_TRACE(exponent);
    MeshOptions options = testing::with_size(0.5);
    for (const Plc::Curve& curve : plc.curves) options.curve_size[curve.tag] = std::ldexp(1.0, -exponent);
    const MeshStatistics s = counted({cube}, options);
    largest.add("moves", s.counts.relocated);
    add_well_spaced(largest, s.counts);
  }
}

// With collars up front and in the pass, which queries the gap size in the mesh.
TEST(WorkCounts, OfAGridOfWedgesAreThoseOfOne) {
  const PolygonSoup wedge = testing::acute::wedge(20).soups[0];
  LargestCounts largest("grid of wedges");
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
      const double wedges = n * n;
      largest.add("degree", s.counts.largest_degree);
      largest.add("cavity", s.counts.largest_cavity);
      largest.add("ripped out of each", static_cast<double>(s.counts.ripped_out) / wedges);
      if (creation == CollarCreation::up_front) continue;
      const auto queries = static_cast<double>(s.counts.gap_queries);
      EXPECT_GT(queries, 0);
      largest.add("gap queries of each", queries / wedges);
      largest.add("cells of a gap query", static_cast<double>(s.counts.gap_cells) / queries);
    }
}

struct Family {
  const char* name;
  Shape (*make)(unsigned n);
};

const Family families[] = {
    {"skew zigzags", [](unsigned n) { return polylines::skew_zigzags(n); }},
    {"skew zigzags with creases", [](unsigned n) { return polylines::skew_zigzags(n, 45); }},
    {"skew combs", [](unsigned n) { return polylines::skew_combs(n / 2); }},
    {"helices", [](unsigned n) { return polylines::helices(n); }},
    {"a knot", [](unsigned n) { return polylines::torus_knot(n); }},
    {"a walk", [](unsigned n) { return polylines::random_walk(n); }},
    {"frames of boxes", [](unsigned n) { return polylines::box_frames(n); }},
    {"a graph", [](unsigned n) { return polylines::graph(n); }},
    {"crossed wires", [](unsigned n) { return polylines::crossed_wires(n / 8); }},
    {"crossed wires far apart", [](unsigned n) { return polylines::crossed_wires(n / 8, n / 32.0); }},
    {"crossed strips", [](unsigned n) { return polylines::crossed_strips(n / 16); }},
    {"a welded mesh", [](unsigned n) { return polylines::welded_mesh(n); }},
    {"outlines of letters", [](unsigned n) { return polylines::outlines(n); }},
    {"a star", [](unsigned n) { return polylines::star(n / 4); }},
};

// Checks that no Delaunay triangulation of the input's vertices is built first: mostly it would be far larger
// than the mesh, and each vertex would destroy a large part of it. If the vertices of a ball are half of its
// radius apart, as the bound on radius-edge ratios allows, it has up to about 60 of them, and twice as many
// cells.
void add_bounded_work(LargestCounts& largest, const WorkCounts& counts, double logarithm) {
  EXPECT_EQ(counts.before_quality, 0U);
  largest.add("cells for each vertex", counts.peak_cells_per_vertex);
  largest.add("cavity outside hubs", counts.largest_cavity_outside_hubs);
  largest.add("moves of an object by logarithm", moves_per_object(counts) / logarithm);
  largest.add("looks of an object by logarithm", looks_per_object(counts) / logarithm);
}

void add_gap_work(LargestCounts& largest, const WorkCounts& counts, double features) {
  if (counts.gap_queries == 0) return;
  const auto queries = static_cast<double>(counts.gap_queries);
  largest.add("interviews of a gap query", static_cast<double>(counts.gap_interviews) / queries / features);
  largest.add("cells of a gap query", static_cast<double>(counts.gap_cells) / queries);
}

TEST(WorkCounts, OfPolylinesAreBoundedAsTheirNumberGrows) {
  LargestCounts largest("polylines by number");
  for (const Family& family : families)
    for (const unsigned n : {60U, 240U, 960U}) {
      SCOPED_TRACE(family.name + std::string(" ") + std::to_string(n));
      const MeshStatistics s = counted(family.make(n).soups, testing::with_size(2));
      add_bounded_work(largest, s.counts, std::log2(n));
    }
}

TEST(WorkCounts, OfPolylinesAreBoundedAsTheirSpreadGrows) {
  LargestCounts largest("polylines by spread");
  for (const int exponent : {1, 2, 3}) {
    const double small = 0.08 * std::pow(10, -exponent);
    for (const Family& family : families) {
      SCOPED_TRACE(family.name + std::string(" ") + std::to_string(small));
      const Shape shape = polylines::with_small_copy(family.make(80), small);
      const MeshStatistics s = counted(shape.soups, testing::with_size(2));
      add_bounded_work(largest, s.counts, std::log2(80 / small));
    }
    SCOPED_TRACE(small);
    const MeshStatistics s = counted(polylines::shrinking_spiral(60, small).soups, testing::with_size(2));
    add_bounded_work(largest, s.counts, std::log2(60 / small));
  }
}

// If narrow gaps are not refined, as before coarsening, a vertex has more cells, but their number must not
// grow with the number of segments. Between two zigzags it could grow with the square of the number of
// segments.
TEST(WorkCounts, OfPolylinesAreBoundedWhereNarrowCellsAreLeft) {
  LargestCounts largest("narrow cells");
  for (const unsigned n : {100U, 400U, 1600U})
    for (const NarrowCells narrow : {NarrowCells::left, NarrowCells::bounded_if_cheap}) {
      SCOPED_TRACE(n);
      MeshOptions options = testing::with_size(10);
      options.narrow_cells = narrow;
      const WorkCounts counts = counted(polylines::skew_zigzags(n).soups, options).counts;
      largest.add("cells for each vertex", counts.peak_cells_per_vertex);
      largest.add("cavity", counts.largest_cavity);
    }
}

namespace acute = testing::acute;

// The work for inputs with collars is bounded, too, and a gap query looks at few features where few are near.
TEST(WorkCounts, OfAcuteFamiliesAreBounded) {
  std::vector<Shape> shapes{acute::star_prism(9, 0.4),
                            acute::spiked_octahedron(1),
                            acute::knife(10),
                            acute::two_knives(10, 20),
                            acute::facet_ending_inside(3),
                            acute::segment_meeting_a_facet(3),
                            acute::cubes_touching_in_an_edge(10),
                            acute::pyramid_on_a_box(20)};
  for (const double angle : {80.0, 40.0, 5.0, 2.0}) shapes.push_back(acute::wedge(angle));
  for (const double small : {1e-1, 1e-2, 1e-4, 1e-6})
    shapes.push_back(acute::wedge_on_a_large_one(20, small));
  for (const unsigned teeth : {2U, 8U, 32U}) shapes.push_back(acute::comb(teeth, 20));
  for (const double away : {0.3, 0.03, 0.01}) shapes.push_back(acute::segment_near_a_crease(20, away));
  LargestCounts largest("acute families");
  for (const Shape& shape : shapes) {
    SCOPED_TRACE(shape.name);
    const MeshStatistics s = counted(shape.soups, testing::with_size(0.3));
    add_bounded_work(largest, s.counts, std::log2(s.counts.located));
    add_gap_work(largest, s.counts, 1);
  }
}

// At a hub a query looks at all features that meet there.
TEST(WorkCounts, AtHubsGrowWithWhatMeetsThere) {
  LargestCounts fans("fans"), stars("stars");
  for (const unsigned k : {8U, 16U, 32U}) {
    SCOPED_TRACE(k);
    const WorkCounts fan = counted(acute::fan(k).soups, testing::with_size(0.3)).counts;
    add_bounded_work(fans, fan, std::log2(fan.located));
    add_gap_work(fans, fan, k);
    const WorkCounts star = counted(polylines::star(4 * k).soups, testing::with_size(2)).counts;
    add_bounded_work(stars, star, std::log2(star.located));
    add_gap_work(stars, star, 4.0 * k);
  }
}

// With every hypothesis of the proofs the work is bounded, too, as the number and the spread grow. No size is
// given.
TEST(WorkCounts, InThePapersProfileAreBounded) {
  MeshOptions options = testing::with_size(0);
  options.profile = Profile::paper;
  LargestCounts largest("paper's profile");
  for (const Family& family : families)
    for (const unsigned n : {30U, 300U}) {
      SCOPED_TRACE(family.name + std::string(" ") + std::to_string(n));
      add_bounded_work(largest, counted(family.make(n).soups, options).counts, std::log2(n));
    }
  for (const int exponent : {1, 3}) {
    const double small = 0.08 * std::pow(10, -exponent);
    SCOPED_TRACE(small);
    for (const Family& family : families) {
      SCOPED_TRACE(family.name);
      const std::vector<PolygonSoup> soups = polylines::with_small_copy(family.make(40), small).soups;
      add_bounded_work(largest, counted(soups, options).counts, std::log2(40 / small));
    }
    const WorkCounts wedges = counted(acute::wedge_on_a_large_one(20, small).soups, options).counts;
    add_bounded_work(largest, wedges, std::log2(wedges.located / small));
  }
}

TEST(WorkCounts, AreMadeOnRequestOnly) {
  const MeshStatistics s =
      generate(build_plc(std::vector{testing::box()}), testing::with_size(0.5)).statistics;
  EXPECT_EQ(s.counts.located, 0U);
  EXPECT_EQ(s.counts.largest_degree, 0U);
}

}  // namespace
}  // namespace collarmesh::work_counts_test
