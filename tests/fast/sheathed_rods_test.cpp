// Thin rods and rings inside other regions are filled, and surrounded, with tetrahedra between rings of
// vertices.
#include "constrained/sheathed_rods.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include "collarmesh/pipeline.h"
#include "collarmesh/plc_builder.h"
#include "collarmesh/repair.h"
#include "remesh/thin_shape.h"
#include "support/meshing.h"
#include "support/shapes.h"

namespace collarmesh::sheathed_rods_test {
namespace {

using namespace testing;

constexpr double size = 1, wire = 0.03;

PolygonSoup ring(double radius, Index around, Index along) {
  PolygonSoup soup;
  for (Index i = 0; i < along; ++i)
    for (Index j = 0; j < around; ++j) {
      const double a = 2 * std::numbers::pi * i / along, b = 2 * std::numbers::pi * j / around,
                   r = radius + wire * std::cos(b);
      soup.points.push_back({r * std::cos(a), r * std::sin(a), wire * std::sin(b)});
    }
  for (Index i = 0; i < along; ++i)
    for (Index j = 0; j < around; ++j) {
      const Index a = i * around, b = (i + 1) % along * around, n = (j + 1) % around;
      soup.add_facet(std::vector<Index>{a + j, b + j, b + n});
      soup.add_facet(std::vector<Index>{a + j, b + n, a + n});
    }
  return soup;
}

Plc ring_in_block(Index around = 48, Index along = 240) {
  return build_plc(std::vector{box({-2, -2, -2}, {2, 2, 2}), ring(1, around, along)});
}
Plc wire_in_block(double radius = wire, double height = 2) {
  return build_repaired_plc(std::vector{cylinder(radius, height, 48), box({-2, -2, 0}, {2, 2, 2})}).plc;
}

std::vector<SheathedRod> rods_in(const Plc& plc, int order = 1) {
  return sheathed_rods(plc, default_tolerance(plc, size, order), {size});
}

void expect_good_shapes(const TetMesh& mesh) {
  remeshing::ExtremeAngles found{180, 0};
  for (const auto& [a, b, c, d] : mesh.tets) {
    const auto [smallest, largest] =
        remeshing::extreme_angles({mesh.points[a], mesh.points[b], mesh.points[c], mesh.points[d]});
    found = {std::min(found.smallest, smallest), std::max(found.largest, largest)};
  }
  EXPECT_GT(found.smallest, 8.2);
  EXPECT_LT(found.largest, 149);
}

double volume_of(const TetMesh& mesh, Index region) {
  double volume = 0;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    if (mesh.tet_region[t] != region) continue;
    const auto& [a, b, c, d] = mesh.tets[t];
    volume += six_volume(mesh.points[a], mesh.points[b], mesh.points[c], mesh.points[d]) / 6;
  }
  return volume;
}

/// Returns the number of faces of tets that belong to one tet only.
std::size_t outer_faces(const TetMesh& mesh) {
  std::map<std::array<Index, 3>, unsigned> faces;
  for (const auto& tet : mesh.tets)
    for (unsigned k = 0; k < 4; ++k) {
      std::array<Index, 3> face{tet[(k + 1) % 4], tet[(k + 2) % 4], tet[(k + 3) % 4]};
      std::ranges::sort(face);
      ++faces[face];
    }
  return static_cast<std::size_t>(std::ranges::count_if(faces, [](const auto& f) { return f.second == 1; }));
}

TEST(SheathedRods, AreRingsInBlocks) {
  const Plc plc = ring_in_block();
  for (const int order : {1, 2}) {
    const std::vector<SheathedRod> rods = rods_in(plc, order);
    ASSERT_EQ(rods.size(), 1U);
    const SheathedRod& rod = rods[0];
    expect_good_shapes(rod.mesh);
    EXPECT_NEAR(volume_of(rod.mesh, rod.region), plc.regions[rod.region].volume,
                (order == 1 ? 0.025 : 0.12) * plc.regions[rod.region].volume);
    EXPECT_EQ(outer_faces(rod.mesh), rod.skin.size());
  }
}

TEST(SheathedRods, AreWiresThroughBlocks) {
  const Plc plc = wire_in_block();
  const std::vector<SheathedRod> rods = rods_in(plc);
  ASSERT_EQ(rods.size(), 1U);
  const SheathedRod& rod = rods[0];
  expect_good_shapes(rod.mesh);
  ASSERT_EQ(rod.ends.size(), 2U);
  const auto at_ends = std::ranges::count_if(rod.mesh.face_patch, [&](Index p) { return p != rod.patch; });
  EXPECT_EQ(outer_faces(rod.mesh), rod.skin.size() + static_cast<std::size_t>(at_ends));
}

TEST(SheathedRods, NeedRoomAndOneRegionAround) {
  const PolygonSoup block = box({-2, -2, -2}, {2, 2, 2});
  EXPECT_TRUE(rods_in(build_plc(std::vector{block})).empty());
  EXPECT_TRUE(rods_in(build_plc(std::vector{ring(1, 24, 48)})).empty());  // stands free
  EXPECT_TRUE(rods_in(wire_in_block(wire, 1.5)).empty());                 // an end lies inside
  EXPECT_TRUE(rods_in(wire_in_block(0.15, 2)).empty());  // the sheath would be wider than the elements
}

class EmbeddedRods : public ::testing::TestWithParam<bool> {};

TEST_P(EmbeddedRods, HaveMeshesThatKeepEveryGuarantee) {
  const Plc plc = GetParam() ? ring_in_block() : wire_in_block();
  PipelineOptions options;
  options.mesh = with_size(size);
  options.mesh.threads = 1;
  const PipelineResult made = run_pipeline(plc, options);
  EXPECT_EQ(made.missed(), "");
  EXPECT_TRUE(std::ranges::any_of(made.check.notes, [](const std::string& note) {
    return note.find("in and around rods") != std::string::npos;
  }));
  for (Index r = 1; r < plc.regions.size(); ++r)
    EXPECT_NEAR(made.check.of_mesh.volumes[r], plc.regions[r].volume, 0.02 * plc.regions[r].volume);
}

INSTANTIATE_TEST_SUITE_P(Shapes, EmbeddedRods, ::testing::Bool(),
                         [](const auto& shape) { return shape.param ? "Ring" : "Wire"; });

}  // namespace
}  // namespace collarmesh::sheathed_rods_test
