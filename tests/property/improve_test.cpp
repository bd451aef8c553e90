// Improvement of a mesh's elements: every guarantee is kept, no sliver is left.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <set>

#include "collarmesh/error.h"
#include "collarmesh/improve.h"
#include "remesh/shape.h"
#include "support/acute_shapes.h"
#include "support/meshing.h"
#include "support/shapes.h"
#include "support/tet_mesh_comparison.h"

namespace collarmesh::improve_test {
namespace {

using testing::mesh_of;
using testing::Meshed;
using testing::with_size;

struct Shape {
  std::string name;
  std::vector<PolygonSoup> soups;
  double size;
  double feature_angle;
};

std::vector<Shape> shapes() {
  using namespace testing;
  return {{"box", {box()}, 0.15, 0},
          {"L", {l_shape()}, 0.25, 0},
          {"plate", {plate_with_hole(1, 16)}, 0.4, 0},
          {"two boxes", {two_boxes()}, 0.2, 0},
          {"dangling facet", {box_with_dangling_facet()}, 0.2, 0},
          {"sphere", {icosphere(1, 8)}, 0.25, 30},
          {"coarse sphere", {icosphere(1, 2)}, 0.2, 60},
          {"sphere in a box", {box({-1, -1, -1}, {1, 1, 1}), icosphere(0.6, 8)}, 0.2, 30},
          {"cylinder", {cylinder(0.5, 1, 40, 4)}, 0.15, 30},
          {"torus", {torus(1, 0.4, 40, 20)}, 0.2, 30},
          {"cylinder in a box", {box({-1, -1, -1}, {1, 1, 1}), cylinder(0.4, 0.8, 32, 3)}, 0.2, 30},
          {"touching boxes", boxes_touching_in_an_edge(), 0.6, 30},
          {"touching rings", rings_touching_in_a_circle(), 0.3, 30},
          {"wedge", acute::wedge(20).soups, 0.1, 0},
          {"fan", acute::fan(8).soups, 0.2, 0},
          {"pyramid", acute::pyramid(5, 15).soups, 0.1, 0}};
}

double quality(const TetMesh& mesh, std::size_t tet) {
  const auto& v = mesh.tets[tet];
  return remeshing::shape_quality(
      {mesh.points[v[0]], mesh.points[v[1]], mesh.points[v[2]], mesh.points[v[3]]});
}

double worst_outside_collars(const TetMesh& mesh) {
  double worst = INFINITY;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    if (mesh.tet_collar[t] == 0) worst = std::min(worst, quality(mesh, t));
  return worst;
}

std::size_t count_below(const TetMesh& mesh, double degrees) {
  std::size_t count = 0;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    count += mesh.tet_collar[t] == 0 && quality(mesh, t) < std::sin(degrees / 180 * 3.141592653589793);
  return count;
}

std::set<std::vector<double>> collar_tets(const TetMesh& mesh) {
  std::set<std::vector<double>> tets;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    if (mesh.tet_collar[t] == 0) continue;
    std::vector<double> corners;
    for (const Index v : mesh.tets[t])
      for (std::size_t axis = 0; axis < 3; ++axis) corners.push_back(mesh.points[v][axis]);
    tets.insert(corners);
  }
  return tets;
}

ImproveOptions without_thin_tets(unsigned level) {
  ImproveOptions options = improve_options(level);
  options.bounds = testing::without_thin();
  return options;
}

class Improve : public ::testing::TestWithParam<unsigned> {};

// At most a fifth of the poor tets may remain, which means nothing for one tet. So at least this many are
// judged together, over several seeds if one seed has fewer. (Over 64 seeds, 4.5% of the pyramid's 537
// remain at level 1 with balls placed up front, and 6.6% of 519 with balls placed in the pass. A single seed
// has 1 to 15; up to a third of them remain in the first case, and all in the second.)
constexpr std::size_t enough_poor = 25;

TEST_P(Improve, KeepsEveryGuaranteeAndLeavesFewPoorTets) {
  for (const Shape& shape : shapes()) {
    SCOPED_TRACE(shape.name);
    std::size_t poor = 0, left = 0;
    for (unsigned seed = 0; poor < enough_poor; ++seed) {
      ASSERT_LT(seed, enough_poor);
      MeshOptions options = with_size(shape.size);
      options.seed = seed;
      Meshed meshed = mesh_of(shape.soups, options, shape.feature_angle);
      ASSERT_EQ(testing::faults(meshed), "");
      TetMesh& mesh = meshed.result.mesh;
      const double worst = worst_outside_collars(mesh);
      const auto collars = collar_tets(mesh);
      poor += count_below(mesh, 15);

      const ImproveReport report = improve(mesh, meshed.plc, without_thin_tets(GetParam()));
      meshed.report = check(mesh, meshed.plc);
      EXPECT_EQ(testing::faults(meshed), "");
      EXPECT_GE(worst_outside_collars(mesh), worst);
      EXPECT_EQ(collar_tets(mesh), collars);
      EXPECT_EQ(report.remaining, count_below(mesh, improve_options(GetParam()).min_dihedral));
      EXPECT_FALSE(report.cancelled);
      left += count_below(mesh, 15);
    }
    EXPECT_LE(left, poor / 5);
  }
}

INSTANTIATE_TEST_SUITE_P(Level, Improve, ::testing::Values(1U, 2U, 3U));

TEST(ImproveBox, LeavesNothingBelowTheBound) {
  Meshed meshed = mesh_of(testing::box(), with_size(0.1), 0);
  improve(meshed.result.mesh, meshed.plc, {.bounds = testing::without_thin()});
  EXPECT_EQ(count_below(meshed.result.mesh, 20), 0U);
}

// Faces and edges on smooth patches and curves change, and must stay near the patches and curves.
TEST(ImproveSmooth, LeavesNothingBelowTheBound) {
  using namespace testing;
  for (const PolygonSoup& soup : {icosphere(1, 8), cylinder(0.5, 1, 40, 4), torus(1, 0.4, 60, 30)}) {
    Meshed meshed = mesh_of(soup, with_size(0.12), 30);
    const ImproveReport report = improve(meshed.result.mesh, meshed.plc, {.bounds = testing::without_thin()});
    EXPECT_GT(report.boundary_flips, 0U);
    EXPECT_EQ(count_below(meshed.result.mesh, 15), 0U);
    meshed.report = check(meshed.result.mesh, meshed.plc);
    EXPECT_EQ(faults(meshed), "");
  }
}

// With hardly any tolerance, hardly anything on the surface may change, and nothing may leave it.
TEST(ImproveSmooth, KeepsATightTolerance) {
  MeshOptions options = with_size(0.3);
  options.bounds.distance = 2e-3;
  Meshed meshed = mesh_of(testing::torus(1, 0.4, 60, 30), options, 30);
  const ImproveReport report =
      improve(meshed.result.mesh, meshed.plc, {.bounds = testing::without_thin(options.bounds.distance)});
  EXPECT_GT(report.edge_removals, 0U);
  meshed.report = check(meshed.result.mesh, meshed.plc, {.bounds = options.bounds});
  EXPECT_EQ(testing::faults(meshed), "");
}

std::string faults_improved_to(double min_dihedral, const std::vector<PolygonSoup>& soups, double size,
                               double distance) {
  MeshOptions options = with_size(size);
  options.bounds.distance = distance;
  Meshed meshed = mesh_of(soups, options, 30);
  ImproveOptions improvement = improve_options(3);
  improvement.min_dihedral = min_dihedral;
  improvement.bounds = testing::without_thin(distance);
  improve(meshed.result.mesh, meshed.plc, improvement);
  meshed.report = check(meshed.result.mesh, meshed.plc, {.bounds = options.bounds});
  return testing::faults(meshed);
}

// The tets at a vertex where bodies touch are not all connected by faces: everything around it stays.
TEST(ImprovePinched, EveryGuaranteeStaysWhereBodiesTouch) {
  using namespace testing;
  for (const double size : {0.3, 0.6, 1.1}) {
    EXPECT_EQ(faults_improved_to(30, boxes_touching_in_an_edge(), size, 0.005), "") << size;
    EXPECT_EQ(faults_improved_to(30, rings_touching_in_a_circle(), size, 0.005), "") << size;
  }
}

// A collapse would destroy the tiny inclusion: neighbours of its triangles are joined, too.
TEST(ImproveInclusion, ATinyOneStays) {
  using namespace testing;
  for (const double bound : {35.0, 40.0})
    EXPECT_EQ(faults_improved_to(bound, {box({-1, -1, -1}, {1, 1, 1}), icosphere(0.02, 3)}, 0.8, 0.05), "");
}

TEST(ImproveBox, SameMeshSameResult) {
  Meshed first = mesh_of(testing::box(), with_size(0.15), 0),
         second = mesh_of(testing::box(), with_size(0.15), 0);
  improve(first.result.mesh, first.plc, {.bounds = testing::without_thin()});
  improve(second.result.mesh, second.plc, {.bounds = testing::without_thin()});
  testing::expect_same(first.result.mesh, second.result.mesh);
}

// Planar and smooth shapes, with curves.
TEST(ImproveThreads, ChangeNothing) {
  using namespace testing;
  for (const PolygonSoup& soup : {box(), cylinder(0.5, 1, 40, 4)}) {
    const Meshed meshed = mesh_of(soup, with_size(0.06), 30);
    ImproveOptions options{.bounds = without_thin()};
    options.threads = 1;
    TetMesh alone = meshed.result.mesh;
    improve(alone, meshed.plc, options);
    for (const unsigned threads : {2U, 5U}) {
      options.threads = threads;
      TetMesh together = meshed.result.mesh;
      improve(together, meshed.plc, options);
      expect_same(alone, together);
    }
  }
}

TEST(ImproveBox, NothingToDo) {
  Meshed meshed = mesh_of(testing::box(), with_size(0.2), 0);
  const TetMesh before = meshed.result.mesh;
  ImproveOptions options{.bounds = testing::without_thin()};
  options.min_dihedral = 0;
  EXPECT_EQ(improve(meshed.result.mesh, meshed.plc, options).candidates, 0U);
  testing::expect_same(before, meshed.result.mesh);
}

TEST(ImproveBox, CancelledInTheMiddleIsStillRight) {
  Meshed meshed = mesh_of(testing::box(), with_size(0.05), 0);
  int reports = 0;
  Execution execution;
  execution.progress = [&](const ProgressReport&) { return ++reports < 2; };
  ImproveOptions options{.bounds = testing::without_thin()};
  options.min_dihedral = 40;
  const ImproveReport report = improve(meshed.result.mesh, meshed.plc, options, execution);
  EXPECT_TRUE(report.cancelled);
  EXPECT_EQ(reports, 2);
  meshed.report = check(meshed.result.mesh, meshed.plc);
  EXPECT_EQ(testing::faults(meshed), "");
}

TEST(ImproveLevels, OthersAreRefused) {
  EXPECT_THROW(improve_options(0), OptionError);
  EXPECT_THROW(improve_options(4), OptionError);
}

TEST(ImproveShape, SmallestSine) {
  using remeshing::shape_quality;
  const double regular = std::sqrt(8.0) / 3;  // the sine of arccos(1/3)
  EXPECT_NEAR(shape_quality({Point{1, 1, 1}, Point{-1, 1, -1}, Point{1, -1, -1}, Point{-1, -1, 1}}), regular,
              1e-12);
  EXPECT_EQ(shape_quality({Point{1, 1, 1}, Point{1, -1, -1}, Point{-1, 1, -1}, Point{-1, -1, 1}}), -1);
  EXPECT_EQ(shape_quality({Point{0, 0, 0}, Point{1, 0, 0}, Point{0, 1, 0}, Point{1, 1, 0}}), 0);
  // The corner of a cube: three right angles, three angles of arccos(1 / sqrt 3).
  EXPECT_NEAR(shape_quality({Point{0, 0, 0}, Point{1, 0, 0}, Point{0, 1, 0}, Point{0, 0, 1}}),
              std::sqrt(2.0 / 3), 1e-12);
}

}  // namespace
}  // namespace collarmesh::improve_test
