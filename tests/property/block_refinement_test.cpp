// Refinement by blocks of vertices: the same mesh with any number of threads, and every guarantee.
#include <gtest/gtest.h>

#include "support/acute_shapes.h"
#include "support/meshing.h"
#include "support/shapes.h"

namespace collarmesh {
namespace {

using testing::faults;
using testing::mesh_of;
using testing::Meshed;
using testing::with_size;

struct Case {
  std::string name;
  std::vector<PolygonSoup> soups;
  double size;
  double least_share;  // of the vertices, in blocks
};

void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

class BlockRefinement : public ::testing::TestWithParam<Case> {};

TEST_P(BlockRefinement, MakesTheSameMeshWithAnyNumberOfThreads) {
  const auto& [name, soups, size, least_share] = GetParam();
  const Plc plc = build_plc(soups);
  MeshOptions options = with_size(size, 120);
  options.threads = 1;
  const Meshed alone = mesh_of(plc, options);
  EXPECT_EQ(faults(alone), "");
  const MeshStatistics& s = alone.result.statistics;
  EXPECT_GT(static_cast<double>(s.vertices_in_blocks),
            least_share * static_cast<double>(s.vertices_inserted));
  for (const unsigned threads : {2U, 3U, 8U}) {
    options.threads = threads;
    const MeshResult together = generate(plc, options);
    EXPECT_EQ(together.statistics.vertices_in_blocks, s.vertices_in_blocks);
    EXPECT_EQ(together.mesh.points, alone.result.mesh.points);
    EXPECT_EQ(together.mesh.tets, alone.result.mesh.tets);
  }
}

INSTANTIATE_TEST_SUITE_P(Shapes, BlockRefinement,
                         ::testing::Values(Case{"box", {testing::box()}, 0.032, 0.6},
                                           Case{"nested_boxes", testing::nested_boxes(2), 0.035, 0.5},
                                           Case{"sphere", {testing::icosphere(1, 12)}, 0.06, 0.5},
                                           Case{"plate", {testing::box({0, 0, 0}, {1, 1, 0.05})}, 0.02, 0.3},
                                           Case{"wedge", testing::acute::wedge(50).soups, 0.02, 0.2}),
                         [](const auto& info) { return info.param.name; });

// Blocks do as the loop does: the mesh is as fine, its tets are as good.
TEST(BlockRefinementSize, IsThatOfTheLoop) {
  const Plc plc = build_plc(std::vector{testing::box()});
  const Meshed blocks = mesh_of(plc, with_size(0.032, 120));
  MeshOptions options = with_size(1, 120);
  options.size_field = [](const Point&) { return 0.032; };  // the loop alone asks the caller
  const Meshed loop = mesh_of(plc, options);
  EXPECT_GT(blocks.result.statistics.vertices_in_blocks, 0U);
  EXPECT_EQ(loop.result.statistics.vertices_in_blocks, 0U);
  EXPECT_NEAR(static_cast<double>(blocks.result.mesh.tets.size()),
              static_cast<double>(loop.result.mesh.tets.size()),
              0.02 * static_cast<double>(loop.result.mesh.tets.size()));
}

TEST(BlockRefinementSize, KeepsToTheBudgetOfVertices) {
  const Plc plc = build_plc(std::vector{testing::box()});
  MeshOptions options = with_size(0.025, 120);
  options.max_vertices = 45'000;
  const MeshResult result = generate(plc, options);
  EXPECT_EQ(result.status, MeshStatus::budget_hit);
  EXPECT_GT(result.statistics.vertices_in_blocks, 0U);
  EXPECT_LE(result.statistics.vertices_inserted, 46'000U);
}

TEST(BlockRefinementSize, OfSmallMeshesIsTheLoopsBusiness) {
  const Meshed small = mesh_of(testing::box(), with_size(0.15));
  EXPECT_EQ(small.result.statistics.vertices_in_blocks, 0U);
}

}  // namespace
}  // namespace collarmesh
