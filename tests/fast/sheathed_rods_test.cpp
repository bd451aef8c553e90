// Thin rods and rings inside other regions are filled, and surrounded, with tetrahedra between rings of
// vertices.
#include "constrained/sheathed_rods.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "collarmesh/pipeline.h"
#include "collarmesh/plc_builder.h"
#include "collarmesh/repair.h"
#include "remesh/thin_shape.h"
#include "support/meshing.h"
#include "support/sanitized.h"
#include "support/shapes.h"
#include "support/tubes.h"

namespace collarmesh::sheathed_rods_test {
namespace {

using namespace testing;

constexpr double size = 1, wire = 0.03;
constexpr Index edges_around = sanitized ? 24 : 48;

Plc ring_in_block(Index around = edges_around, Index along = 5 * edges_around) {
  return build_plc(std::vector{box({-2, -2, -2}, {2, 2, 2}), wire_ring(1, wire, around, along)});
}
Plc wire_in_block(double radius = wire, double height = 2) {
  return build_repaired_plc(std::vector{cylinder(radius, height, edges_around), box({-2, -2, 0}, {2, 2, 2})})
      .plc;
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
  EXPECT_TRUE(rods_in(build_plc(std::vector{wire_ring(1, wire, 24, 48)})).empty());  // stands free
  EXPECT_TRUE(rods_in(wire_in_block(wire, 1.5)).empty());                            // an end lies inside
  EXPECT_TRUE(rods_in(wire_in_block(0.15, 2)).empty());  // the sheath would be wider than the elements
}

/// A shape, and the order of the elements.
struct Embedded {
  bool is_ring;
  int order;

  Plc plc() const { return is_ring ? ring_in_block() : wire_in_block(); }
};

PipelineOptions one_thread(int order) {
  PipelineOptions options;
  options.mesh = with_size(size);
  options.mesh.threads = 1;
  options.order = order;
  return options;
}

class EmbeddedRods : public ::testing::TestWithParam<Embedded> {};

TEST_P(EmbeddedRods, HaveMeshesThatKeepEveryGuarantee) {
  const Plc plc = GetParam().plc();
  const PipelineResult made = run_pipeline(plc, one_thread(GetParam().order));
  EXPECT_EQ(made.missed(), "");
  EXPECT_TRUE(std::ranges::any_of(made.check.notes, [](const std::string& note) {
    return note.find("in and around rods") != std::string::npos;
  }));
  const double off = GetParam().order == 1 ? 0.02 : 0.01;
  for (Index r = 1; r < plc.regions.size(); ++r)
    EXPECT_NEAR(made.check.of_mesh.volumes[r], plc.regions[r].volume, off * plc.regions[r].volume);
}

INSTANTIATE_TEST_SUITE_P(Shapes, EmbeddedRods,
                         ::testing::Values(Embedded{true, 2}, Embedded{false, 1}, Embedded{false, 2}),
                         [](const auto& shape) {
                           return std::string(shape.param.is_ring ? "Ring" : "Wire") +
                                  std::to_string(shape.param.order);
                         });

TEST(SheathedRods, KeepTagsAndNames) {
  Plc plc = wire_in_block();
  Tag tag = 10;
  for (Plc::Patch& patch : plc.patches) patch.tag = tag++;
  for (Plc::Curve& curve : plc.curves) curve.tag = tag++;
  for (std::size_t r = 1; r < plc.regions.size(); ++r) plc.regions[r].tag = tag++;
  plc.names.set(3, plc.regions[1].tag, "copper");
  const TetMesh mesh = run_pipeline(plc, one_thread(2)).result.mesh;
  EXPECT_EQ(mesh.names.of(3), plc.names.of(3));
  std::vector<bool> has_patch(plc.patches.size(), false), has_region(plc.regions.size(), false);
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const Index patch = mesh.face_patch[f];
    has_patch[patch] = true;
    EXPECT_EQ(mesh.face_tag[f], plc.patches[patch].tag);
    const auto& regions = plc.patches[patch].regions;
    EXPECT_TRUE(std::ranges::is_permutation(mesh.face_regions[f], regions));
  }
  for (std::size_t e = 0; e < mesh.edges.size(); ++e)
    EXPECT_EQ(mesh.edge_tag[e], plc.curves[mesh.edge_curve[e]].tag);
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    has_region[mesh.tet_region[t]] = true;
    EXPECT_EQ(mesh.tet_tag[t], plc.regions[mesh.tet_region[t]].tag);
  }
  EXPECT_EQ(std::ranges::count(has_patch, false), 0);
  EXPECT_EQ(std::ranges::count(has_region, false), 1);  // the outside
}

TEST(SheathedRods, AreTheSameWithMoreThreads) {
  const Plc plc = wire_in_block();
  PipelineOptions options = one_thread(2);
  const TetMesh one = run_pipeline(plc, options).result.mesh;
  options.mesh.threads = 2;
  const TetMesh two = run_pipeline(plc, options).result.mesh;
  EXPECT_EQ(one.points, two.points);
  EXPECT_EQ(one.tets, two.tets);
}

TEST(SheathedRods, AreCancelledInEveryStage) {
  const Plc plc = wire_in_block(0.1);
  for (const bool at_begin : {true, false})
    for (const std::string stage :
         {"refine", "tetrahedralize", "coarsen", "improve", "second order", "check"}) {
      bool asked = false;
      Execution execution;
      execution.progress = [&](const ProgressReport& report) {
        const bool stops = report.phase == stage && report.begins == at_begin;
        asked |= stops;
        return !stops;
      };
      const PipelineResult made = run_pipeline(plc, one_thread(2), execution);
      EXPECT_TRUE(asked || !at_begin) << stage;
      if (!asked) continue;  // stages that take little time report their beginning only
      EXPECT_EQ(made.result.status, MeshStatus::cancelled) << stage;
      EXPECT_TRUE(made.result.mesh.tets.empty()) << stage;
    }
}

}  // namespace
}  // namespace collarmesh::sheathed_rods_test
