// Refinement by blocks of vertices: the same mesh with any number of threads, and every guarantee.
#include <gtest/gtest.h>

#include "support/acute_shapes.h"
#include "support/meshing.h"
#include "support/shapes.h"

namespace collarmesh::block_refinement_test {
namespace {

using testing::faults;
using testing::mesh_of;
using testing::Meshed;
using testing::with_size;

struct Case {
  std::string name;
  std::vector<PolygonSoup> soups;
  double size;
  double least_share;  // least share of the vertices that must be inserted in blocks
};

void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

class BlockRefinement : public ::testing::TestWithParam<Case> {};

TEST_P(BlockRefinement, MakesTheSameMeshWithAnyNumberOfThreads) {
  const auto& [name, soups, size, least_share] = GetParam();
  const Plc plc = build_plc(soups);
  MeshOptions options = with_size(size);
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
    EXPECT_EQ(together.mesh.faces, alone.result.mesh.faces);
    EXPECT_EQ(together.mesh.face_patch, alone.result.mesh.face_patch);
    EXPECT_EQ(together.statistics.yields, s.yields);
    EXPECT_EQ(together.statistics.peak_bytes, s.peak_bytes);
  }
}

INSTANTIATE_TEST_SUITE_P(Shapes, BlockRefinement,
                         ::testing::Values(Case{"box", {testing::box()}, 0.032, 0.6},
                                           Case{"nested_boxes", testing::nested_boxes(2), 0.035, 0.5},
                                           Case{"sphere", {testing::icosphere(1, 12)}, 0.06, 0.5},
                                           Case{"plate", {testing::box({0, 0, 0}, {1, 1, 0.05})}, 0.02, 0.3},
                                           Case{"wedge", testing::acute::wedge(50).soups, 0.02, 0.2}),
                         [](const auto& info) { return info.param.name; });

// Blocks make the same kind of mesh as the loop: as fine, with tets as good and as many vertices on the
// surface.
TEST(BlockRefinementSize, IsThatOfTheLoop) {
  const Case cases[]{{"box", {testing::box()}, 0.032, 0},
                     {"sphere", {testing::icosphere(1, 12)}, 0.06, 0},
                     {"plate", {testing::box({0, 0, 0}, {1, 1, 0.05})}, 0.02, 0}};
  for (const auto& [name, soups, size, least_share] : cases) {
    SCOPED_TRACE(name);
    const Plc plc = build_plc(soups);
    const Meshed blocks = mesh_of(plc, with_size(size));
    MeshOptions options = with_size(1);
    options.size_field = [wanted = size](const Point&) { return wanted; };  // only the loop calls a caller's
                                                                            // function
    const Meshed loop = mesh_of(plc, options);
    EXPECT_EQ(faults(blocks), "");
    EXPECT_EQ(loop.result.statistics.vertices_in_blocks, 0U);
    // Most vertices of the plate lie on its surface.
    EXPECT_GT(blocks.result.statistics.vertices_in_blocks, blocks.result.statistics.vertices_inserted / 2);
    const auto expect_as_many = [](std::size_t a, std::size_t b) {
      EXPECT_NEAR(static_cast<double>(a), static_cast<double>(b), 0.02 * static_cast<double>(b));
    };
    expect_as_many(blocks.result.mesh.tets.size(), loop.result.mesh.tets.size());
    expect_as_many(blocks.result.mesh.faces.size(), loop.result.mesh.faces.size());
    expect_as_many(blocks.result.mesh.edges.size(), loop.result.mesh.edges.size());
  }
}

TEST(BlockRefinementSize, KeepsToTheBudgetOfVertices) {
  const Plc plc = build_plc(std::vector{testing::box()});
  MeshOptions options = with_size(0.025);
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
}  // namespace collarmesh::block_refinement_test
