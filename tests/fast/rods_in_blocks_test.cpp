// Rods inside other regions get sheaths only where there is room; otherwise nothing changes.
#include "pipeline/rods_in_blocks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "collarmesh/plc_builder.h"
#include "collarmesh/repair.h"
#include "pipeline/mesh_maker.h"
#include "pipeline/rod_room.h"
#include "remesh/thin_shape.h"
#include "support/meshing.h"
#include "support/shapes.h"
#include "support/tubes.h"

namespace collarmesh::testing::rods_in_blocks_test {
namespace {

constexpr double size = 1, wire = 0.03, height = 2;

PolygonSoup wire_at(double x, double radius = wire) {
  return translated(cylinder(radius, height, 24), {x, 0, 0});
}
Plc wires_in_block(const std::vector<PolygonSoup>& wires, double half = 2) {
  std::vector<PolygonSoup> soups = wires;
  soups.push_back(box({-half, -2, 0}, {half, 2, height}));
  return build_repaired_plc(soups).plc;
}

/// Returns a closed tube around a curve that goes around the z axis twice, while it goes around a circle of
/// this radius once.
PolygonSoup double_loop(double apart) {
  constexpr double radius = 0.02;
  constexpr Index around = 48, along = 480;
  PolygonSoup soup;
  for (Index i = 0; i < along; ++i)
    for (Index j = 0; j < around; ++j) {
      const double a = 4 * std::numbers::pi * i / along, b = 2 * std::numbers::pi * j / around,
                   r = 1 + apart * std::cos(a / 2) + radius * std::cos(b);
      soup.points.push_back(
          {r * std::cos(a), r * std::sin(a), apart * std::sin(a / 2) + radius * std::sin(b)});
    }
  add_tube(soup, around, true);
  return soup;
}

/// Returns a block with a wire that is straight, bends by a quarter of a turn, and is straight again.
Plc bent_wire_in_block() {
  constexpr double radius = 0.04, bend = 1.5, first_leg = 0.5, second_leg = 2;
  constexpr Index around = 48, in_bend = 48, in_leg = 8;
  PolygonSoup tube;
  const auto add_section = [&](const Point& centre, double turned) {
    for (Index j = 0; j < around; ++j) {
      const double a = 2 * std::numbers::pi * j / around, away = radius * std::cos(a);
      tube.points.push_back({centre.x - away * std::cos(turned), centre.y + radius * std::sin(a),
                             centre.z + away * std::sin(turned)});
    }
  };
  for (Index i = 0; i < in_leg; ++i) add_section({0, 0, first_leg * i / in_leg}, 0);
  for (Index i = 0; i <= in_bend; ++i) {
    const double turned = std::numbers::pi / 2 * i / in_bend;
    add_section({bend - bend * std::cos(turned), 0, first_leg + bend * std::sin(turned)}, turned);
  }
  for (Index i = 1; i <= in_leg; ++i)
    add_section({bend + second_leg * i / in_leg, 0, first_leg + bend}, std::numbers::pi / 2);
  add_tube(tube, around, false);
  for (const Index first : {Index{0}, static_cast<Index>(tube.points.size()) - around}) {
    std::vector<Index> cap;
    for (Index j = 0; j < around; ++j) cap.push_back(first + j);
    tube.add_facet(cap);
  }
  return build_repaired_plc(std::vector{tube, box({-1.5, -2, 0}, {bend + second_leg, 2, 4})}).plc;
}

/// Returns the number of rods that may have sheaths, and of those with room.
std::pair<std::size_t, std::size_t> count_rods(const Plc& plc) {
  std::vector<SheathedRod> rods = sheathed_rods(plc, default_tolerance(plc, size), {size});
  const std::size_t all = rods.size();
  pipeline::remove_rods_without_room(plc, rods, {});
  return {all, rods.size()};
}

using Counts = std::pair<std::size_t, std::size_t>;

TEST(RodsInBlocks, HaveRoomFarFromOthers) {
  EXPECT_EQ(count_rods(wires_in_block({wire_at(0)})), (Counts{1, 1}));
  EXPECT_EQ(count_rods(wires_in_block({wire_at(-0.6), wire_at(0.6)})), (Counts{2, 2}));
  EXPECT_EQ(count_rods(wires_in_block({wire_at(-0.25), wire_at(0.25)})), (Counts{2, 1}));
  EXPECT_EQ(count_rods(wires_in_block({wire_at(-0.1), wire_at(0.1)})), (Counts{2, 0}));
  EXPECT_EQ(count_rods(wires_in_block({wire_at(0)}, 0.25)), (Counts{1, 0}));  // near the sides
  EXPECT_EQ(count_rods(wires_in_block({wire_at(0), wire_at(0, 1.2 * wire)})), (Counts{1, 0}));  // in a coat
}

TEST(RodsInBlocks, HaveRoomFarFromThemselves) {
  const PolygonSoup block = box({-2, -2, -2}, {2, 2, 2});
  EXPECT_EQ(count_rods(build_plc(std::vector{block, double_loop(0.4)})), (Counts{1, 1}));
  EXPECT_EQ(count_rods(build_plc(std::vector{block, double_loop(0.1)})), (Counts{1, 0}));
}

PipelineOptions second_order() {
  PipelineOptions options;
  options.mesh = with_size(size);
  options.mesh.threads = 1;
  options.order = 2;
  return options;
}

/// A job whose options are set for a complex.
struct Prepared {
  Prepared(const Plc& plc, const PipelineOptions& options) : job(options, execution), maker(job, nullptr) {
    maker.make(plc, options.mesh.seed);
  }
  const TetMesh& mesh() const { return job.made.result.mesh; }

  Execution execution;
  pipeline::MeshJob job;
  pipeline::MeshMaker maker;
};

/// Makes a sheath so wide that it reaches the sides of the block.
void widen(SheathedRod& rod) { rod.reach *= 12; }

TEST(RodsInBlocks, LeaveNothingBehindIfTheRefinedMeshHasNoRoom) {
  const Plc plc = wires_in_block({wire_at(0, 0.1)});
  PipelineOptions options = second_order();
  Prepared prepared(plc, options);
  std::vector<SheathedRod> rods = find_sheathed_rods(prepared.job);
  ASSERT_EQ(rods.size(), 1U);
  widen(rods[0]);
  std::vector<Index> fixed;
  EXPECT_FALSE(refine_around_rods(prepared.job, rods, fixed, pipeline::Fineness::any));
  EXPECT_TRUE(rods.empty());
  prepared.job.start = options.start = Start::refinement;
  prepared.maker.make(plc, options.mesh.seed);
  const Prepared wanted(plc, options);
  EXPECT_TRUE(prepared.mesh().points == wanted.mesh().points && prepared.mesh().tets == wanted.mesh().tets);
}

bool keeps_angles(const TetMesh& mesh) {
  return std::ranges::all_of(mesh.tets, [&](const std::array<Index, 4>& tet) {
    const auto& p = mesh.points;
    const auto angles = remeshing::extreme_angles({p[tet[0]], p[tet[1]], p[tet[2]], p[tet[3]]});
    return angles.smallest >= 8 && angles.largest <= 150;
  });
}

// A refinement around rods whose sheath misses the bounds on angles would be in vain.
TEST(RodsInBlocks, StayOutIfTheirSheathMissesBoundsOnAngles) {
  const Plc plc = bent_wire_in_block();
  const std::vector<SheathedRod> rods = sheathed_rods(plc, default_tolerance(plc, size), {size});
  ASSERT_EQ(rods.size(), 1U);
  EXPECT_FALSE(keeps_angles(rods[0].mesh));
  PipelineOptions options = second_order();
  options.order = 1;
  options.coarsen = false;  // a tenth of the time
  Prepared prepared(plc, options);
  EXPECT_TRUE(find_sheathed_rods(prepared.job).empty());
}

TEST(RodsInBlocks, StayOutOneByOne) {
  const Plc plc = wires_in_block({wire_at(-0.6), wire_at(0.6)});
  Prepared prepared(plc, second_order());
  std::vector<SheathedRod> rods = find_sheathed_rods(prepared.job);
  ASSERT_EQ(rods.size(), 2U);
  const Index other = rods[1].region;
  widen(rods[0]);
  std::vector<Index> fixed;
  EXPECT_TRUE(refine_around_rods(prepared.job, rods, fixed, pipeline::Fineness::any));
  ASSERT_EQ(rods.size(), 1U);
  EXPECT_EQ(rods[0].region, other);
  EXPECT_EQ(fixed.size(), rods[0].fixed.size());
}

TEST(RodsInBlocks, HaveNoMoreVerticesThanAsked) {
  const Plc plc = wires_in_block({wire_at(0)});
  PipelineOptions options = second_order();
  Prepared prepared(plc, options);
  std::vector<SheathedRod> rods = find_sheathed_rods(prepared.job);
  std::vector<Index> fixed;
  ASSERT_TRUE(refine_around_rods(prepared.job, rods, fixed, pipeline::Fineness::any));
  options.mesh.max_vertices = prepared.job.made.result.mesh.points.size() - 1;
  pipeline::MeshJob job(options, prepared.execution);
  pipeline::MeshMaker maker(job, nullptr);
  EXPECT_THROW(maker.make(plc, options.mesh.seed), Ended);  // as does the refinement of the whole complex
}

TEST(RodsInBlocks, AreNoneIfCancelled) {
  const Plc plc = wires_in_block({wire_at(0)});
  const std::atomic<bool> flag{true};
  Execution execution;
  execution.cancel = &flag;
  EXPECT_TRUE(sheathed_rods(plc, default_tolerance(plc, size), {size}, execution).empty());
  std::vector<SheathedRod> rods = sheathed_rods(plc, default_tolerance(plc, size), {size});
  pipeline::remove_rods_without_room(plc, rods, execution);
  EXPECT_TRUE(rods.empty());
}

}  // namespace
}  // namespace collarmesh::testing::rods_in_blocks_test
