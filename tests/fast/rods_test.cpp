// Thin rods are filled with tetrahedra between rings of vertices.
#include "constrained/rods.h"

#include <gtest/gtest.h>

#include <atomic>
#include <set>
#include <vector>

#include "collarmesh/check.h"
#include "collarmesh/plc_builder.h"
#include "remesh/cell_bounds.h"
#include "support/shapes.h"
#include "support/tubes.h"

namespace collarmesh::rods_test {
namespace {

using namespace testing;

constexpr double size = 1;

std::optional<TetMesh> rods_of(const Plc& plc, int order = 1) {
  return tetrahedra_of_rods(plc, default_tolerance(plc, size, order), {size});
}

void expect_good(const Plc& plc, const TetMesh& mesh, double off) {
  TetMesh marked = mesh;
  Bounds bounds;
  bounds.tolerance = default_tolerance(plc, size);
  remeshing::mark_cells(marked, plc, bounds);
  const CheckReport report = check(marked, plc, {.bounds = bounds});
  for (const Finding& finding : report.findings) ADD_FAILURE() << finding.message;
  std::vector<double> volumes(plc.regions.size(), 0);
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const auto& [a, b, c, d] = mesh.tets[t];
    volumes[mesh.tet_region[t]] +=
        six_volume(mesh.points[a], mesh.points[b], mesh.points[c], mesh.points[d]) / 6;
  }
  for (Index r = 1; r < plc.regions.size(); ++r)
    EXPECT_NEAR(volumes[r], plc.regions[r].volume, off * plc.regions[r].volume);
}

TEST(Rods, HaveRingsSomeRadiiApart) {
  constexpr double radius = 0.02, length = 20;
  const Plc plc = build_plc(std::vector{cylinder(radius, length, 96)});
  const auto mesh = rods_of(plc);
  ASSERT_TRUE(mesh);
  expect_good(plc, *mesh, 0.02);
  EXPECT_LT(static_cast<double>(mesh->tets.size()), 12 * length / radius);
}

TEST(Rods, KeepTheEdgesOfCoarseSurfaces) {
  const Plc plc = build_plc(std::vector{cylinder(0.05, 10, 24)});
  const auto mesh = rods_of(plc);
  ASSERT_TRUE(mesh);
  expect_good(plc, *mesh, 1e-6);
}

TEST(Rods, HaveFewerVerticesAroundWithSecondOrder) {
  const Plc plc = build_plc(std::vector{cylinder(0.05, 10, 96)});
  const auto mesh = rods_of(plc, 2);
  ASSERT_TRUE(mesh);
  EXPECT_LT(2 * mesh->points.size(), rods_of(plc)->points.size());
}

TEST(Rods, MayBeSeveralBodies) {
  const PolygonSoup one = cylinder(0.05, 5, 48);
  const Plc plc = build_plc(std::vector{one, translated(one, {1, 0, 0})});
  const auto mesh = rods_of(plc);
  ASSERT_TRUE(mesh);
  expect_good(plc, *mesh, 0.02);
  EXPECT_EQ(std::set<Index>(mesh->tet_region.begin(), mesh->tet_region.end()).size(), 2U);
}

TEST(Rods, MayBeBentAndClosed) {
  const Plc plc = build_plc(std::vector{wire_ring(3, 0.2, 24, 120)});
  const auto mesh = rods_of(plc);
  ASSERT_TRUE(mesh);
  expect_good(plc, *mesh, 0.02);
  EXPECT_TRUE(mesh->edges.empty());
}

TEST(Rods, HaveNoMoreVerticesThanAsked) {
  const Plc plc = build_plc(std::vector{cylinder(0.2, 3, 24)});
  const SurfaceTolerance tolerance = default_tolerance(plc, size);
  const std::size_t vertices = rods_of(plc)->points.size();
  EXPECT_TRUE(tetrahedra_of_rods(plc, tolerance, {size, vertices}));
  EXPECT_FALSE(tetrahedra_of_rods(plc, tolerance, {size, vertices - 1}));
}

TEST(Rods, AreCancelled) {
  const Plc plc = build_plc(std::vector{cylinder(0.2, 3, 24)});
  const std::atomic<bool> flag{true};
  Execution execution;
  execution.cancel = &flag;
  EXPECT_FALSE(tetrahedra_of_rods(plc, default_tolerance(plc, size), {size}, execution));
}

TEST(Rods, AreThinRoundAndAlone) {
  const auto is_rod = [](const std::vector<PolygonSoup>& soups) {
    return rods_of(build_plc(soups)).has_value();
  };
  EXPECT_FALSE(is_rod({cylinder(0.6, 20, 48)}));
  EXPECT_FALSE(is_rod({cylinder(0.05, 0.3, 48)}));
  EXPECT_FALSE(is_rod({box()}));
  EXPECT_FALSE(is_rod({icosphere(0.2, 8)}));
  EXPECT_FALSE(is_rod({transformed(cylinder(0.05, 10, 48), [](const Point& p) {
    return Point{2 * p.x, p.y, p.z};
  })}));
  EXPECT_FALSE(is_rod({cylinder(0.05, 10, 48), box({-1, -1, -1}, {1, 1, 11})}));
}

}  // namespace
}  // namespace collarmesh::rods_test
