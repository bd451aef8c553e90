// Detours of improvement: afterwards the whole mesh is better, compared from its worst tet up, or unchanged.
#include "improve/detours.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "collarmesh/check.h"
#include "collarmesh/coarsen.h"
#include "collarmesh/improve.h"
#include "improve/operation_chooser.h"
#include "support/acute_shapes.h"
#include "support/meshing.h"
#include "support/shapes.h"
#include "support/tet_mesh_comparison.h"

namespace collarmesh::detours_test {
namespace {

using remeshing::EditableMesh;
using remeshing::Operations;
using remeshing::SliverRule;
using remeshing::improvement::Detours;
using remeshing::improvement::OperationChooser;
using testing::Meshed;

constexpr double reached_angle = 33, wanted_angle = 38, hopeless_angle = 65;

std::vector<Meshed> meshes() {
  using namespace testing;
  std::vector<Meshed> made;
  made.push_back(mesh_of(box(), with_size(0.2), 0));
  made.push_back(mesh_of(cylinder(0.5, 1, 40, 4), with_size(0.2), 30));
  made.push_back(
      mesh_of(std::vector<PolygonSoup>{box({-1, -1, -1}, {1, 1, 1}), icosphere(0.6, 8)}, with_size(0.4), 30));
  made.push_back(mesh_of(acute::wedge(20).soups, with_size(0.2), 0));
  return made;
}

ImproveOptions options(double angle) {
  ImproveOptions made = improve_options(3);
  made.min_dihedral = angle;
  made.bounds = testing::without_thin();
  return made;
}

/// The objects that detours work with.
struct Bench {
  explicit Bench(Meshed& meshed, double wanted = wanted_angle)
      : edited(meshed.result.mesh, meshed.plc,
               SurfaceTolerance(default_distance(0, meshed.plc.bounds.diagonal()))),
        rule(options(wanted).bounds.radius_edge),
        chooser(edited, rule, options(wanted)),
        operations(edited, rule) {
    edited.prepare();
  }

  Detours detours(std::size_t most_trials) { return {edited, chooser, operations, most_trials}; }

  std::vector<Index> poor() const {
    std::vector<Index> found;
    for (Index t = 0; t < edited.complex.size(); ++t)
      if (chooser.poor_quality(t) < INFINITY) found.push_back(t);
    return found;
  }

  /// Returns the qualities of poor tets, sorted.
  std::vector<double> poor_qualities() const {
    std::vector<double> found;
    for (const Index t : poor()) found.push_back(chooser.quality(t));
    std::sort(found.begin(), found.end());
    return found;
  }

  /// Returns all tets, in no order.
  std::multiset<std::array<Index, 4>> tets() const {
    std::multiset<std::array<Index, 4>> found;
    for (Index t = 0; t < edited.complex.size(); ++t)
      if (edited.complex[t].alive) found.insert(edited.complex[t].corners);
    return found;
  }

  EditableMesh edited;
  SliverRule rule;
  OperationChooser chooser;
  Operations operations;
};

bool never() { return false; }

// Returns whether qualities are better; fewer poor ones are better, too. The same tet may differ by rounding.
bool is_better(std::vector<double> now, std::vector<double> before) {
  const std::size_t size = std::max(now.size(), before.size());
  now.resize(size, INFINITY);
  before.resize(size, INFINITY);
  for (std::size_t i = 0; i < size; ++i)
    if (std::fabs(now[i] - before[i]) > 1e-9) return now[i] > before[i];
  return false;
}

// Takes a detour for the tet, and compares the mesh with that before.
bool take_and_compare(Meshed& meshed, Bench& bench, Index tet) {
  const auto before = bench.poor_qualities();
  const auto tets = bench.tets();
  const TetMesh was = meshed.result.mesh;
  const bool taken = bench.detours(100).take_all({tet}, never) > 0;
  if (taken) {
    EXPECT_TRUE(is_better(bench.poor_qualities(), before));
  } else {
    EXPECT_EQ(bench.tets(), tets);
    testing::expect_same(meshed.result.mesh, was);
  }
  return taken;
}

TEST(Detours, MakeTheMeshBetter) {
  std::size_t taken = 0;
  for (Meshed& meshed : meshes()) {
    improve(meshed.result.mesh, meshed.plc, options(reached_angle));
    Bench bench(meshed);
    std::vector<Index> poor = bench.poor();
    poor.resize(std::min<std::size_t>(poor.size(), 15));
    for (const Index tet : poor)
      if (bench.chooser.poor_quality(tet) < INFINITY) taken += take_and_compare(meshed, bench, tet) ? 1 : 0;
    bench.edited.store();
    meshed.report = check(meshed.result.mesh, meshed.plc);
    EXPECT_EQ(testing::faults(meshed), "");
  }
  EXPECT_GT(taken, 0U);
}

// Planar and smooth shapes, with curves. Most trials fail in narrow places, of which these meshes have few.
TEST(Detours, LeaveTheMeshAsItWas) {
  using namespace testing;
  std::size_t refused = 0;
  for (const auto& [soup, size] :
       {std::pair{box(), 0.6}, std::pair{box(), 1.5}, std::pair{icosphere(1, 4), 2.0},
        std::pair{cylinder(0.5, 0.2, 12, 1), 0.6}}) {
    Meshed meshed = mesh_of(soup, with_size(size), 30);
    Bench bench(meshed, hopeless_angle);
    std::vector<Index> poor = bench.poor();
    poor.resize(std::min<std::size_t>(poor.size(), 15));
    for (const Index tet : poor)
      if (bench.chooser.poor_quality(tet) < INFINITY) refused += take_and_compare(meshed, bench, tet) ? 0 : 1;
    bench.edited.store();
    meshed.report = check(meshed.result.mesh, meshed.plc);
    EXPECT_EQ(testing::faults(meshed), "");
  }
  EXPECT_GT(refused, 0U);
}

TEST(Detours, StopWhenTheyAreTold) {
  for (Meshed& meshed : meshes()) {
    improve(meshed.result.mesh, meshed.plc, options(reached_angle));
    Bench bench(meshed);
    ASSERT_FALSE(bench.poor().empty());
    const auto tets = bench.tets();
    EXPECT_EQ(bench.detours(0).take_all(bench.poor(), never), 0U);
    EXPECT_EQ(bench.detours(1000).take_all(bench.poor(), [] { return true; }), 0U);
    EXPECT_EQ(bench.tets(), tets);
  }
}

// No tet can be that good: all trials are used up, including those of the last tet.
TEST(Detours, AHopelessBoundEnds) {
  constexpr std::size_t most_of_one_tet = 24 * 30;
  for (Meshed& meshed : meshes()) {
    Bench bench(meshed, hopeless_angle);
    Detours detours = bench.detours(100);
    detours.take_all(bench.poor(), never);
    EXPECT_GE(detours.trials(), 100U);
    EXPECT_LT(detours.trials(), 100U + most_of_one_tet);
    bench.edited.store();
    EXPECT_EQ(improve(meshed.result.mesh, meshed.plc, options(hopeless_angle)).detours, 0U);
    meshed.report = check(meshed.result.mesh, meshed.plc);
    EXPECT_EQ(testing::faults(meshed), "");
  }
}

// In a coarsened mesh, where tets may be thin.
TEST(Detours, KeepTheGuaranteesOfThinTets) {
  using namespace testing;
  std::size_t taken = 0;
  for (const auto& [soup, size] :
       {std::pair{cylinder(0.5, 1, 40, 4), 0.3}, std::pair{torus(1, 0.25, 80, 24), 0.3},
        std::pair{plate_with_hole(1, 32), 0.7}, std::pair{l_shape(), 0.4}}) {
    MeshOptions sizes = with_size(size);
    sizes.bounds.distance = 0.1 * size;
    Meshed meshed = mesh_of(soup, sizes, 30);
    coarsen(meshed.result.mesh, meshed.plc, sizes);
    ImproveOptions with = options(reached_angle);
    with.bounds.distance = sizes.bounds.distance;
    with.bounds.thin_angle = 8;
    with.keep_vertices = true;
    const ImproveReport report = improve(meshed.result.mesh, meshed.plc, with);
    taken += report.detours;
    CheckOptions judge;
    judge.bounds.distance = sizes.bounds.distance;
    meshed.report = check(meshed.result.mesh, meshed.plc, judge);
    EXPECT_EQ(faults(meshed), "");
  }
  EXPECT_GT(taken, 0U);
}

TEST(Detours, CancelledAmongThemItIsStillRight) {
  Meshed meshed = std::move(meshes()[1]);
  TetMesh whole = meshed.result.mesh;
  int reports = 0;
  Execution execution;
  execution.progress = [&](const ProgressReport&) { return ++reports > 0; };
  ASSERT_GT(improve(whole, meshed.plc, options(reached_angle), execution).detours, 0U);
  execution.progress = [&](const ProgressReport&) { return --reports > 0; };
  const ImproveReport report = improve(meshed.result.mesh, meshed.plc, options(reached_angle), execution);
  EXPECT_TRUE(report.cancelled);
  EXPECT_EQ(reports, 0);
  meshed.report = check(meshed.result.mesh, meshed.plc);
  EXPECT_EQ(testing::faults(meshed), "");
}

TEST(Detours, ThreadsChangeNothing) {
  std::size_t taken = 0;
  for (const Meshed& meshed : meshes()) {
    ImproveOptions with = options(reached_angle);
    with.threads = 1;
    TetMesh alone = meshed.result.mesh;
    taken += improve(alone, meshed.plc, with).detours;
    for (const unsigned threads : {2U, 5U}) {
      with.threads = threads;
      TetMesh together = meshed.result.mesh;
      improve(together, meshed.plc, with);
      testing::expect_same(alone, together);
    }
  }
  EXPECT_GT(taken, 0U);
}

}  // namespace
}  // namespace collarmesh::detours_test
