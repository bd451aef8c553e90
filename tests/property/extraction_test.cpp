// Refined meshes as later stages get them: their order in memory, and the tets' neighbours.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "common/tet_sides.h"
#include "refine/generate_linked.h"
#include "remesh/tet_complex.h"
#include "support/acute_shapes.h"
#include "support/expected_counts.h"
#include "support/meshing.h"
#include "support/shapes.h"

namespace collarmesh::extraction_test {
namespace {

struct Shape {
  std::string name;
  std::vector<PolygonSoup> soups;
  double size;
};

std::vector<Shape> shapes() {
  using namespace testing;
  return {{"box", {box()}, 0.08},
          {"two boxes", {two_boxes()}, 0.35},
          {"touching boxes", boxes_touching_in_an_edge(), 0.6},
          {"dangling facet", {box_with_dangling_facet()}, 0.3},
          {"plate", {plate_with_hole(1, 16)}, 0.6},
          {"wedge", acute::wedge(20).soups, 0.25},
          {"fan", acute::fan(12).soups, 0.3},
          {"sectors", acute::sectors(9).soups, 0.3}};
}

/// Returns for each triangle, by sorted corners, the tets that have it as a side.
std::map<std::array<Index, 3>, std::vector<Index>> sides(const TetMesh& mesh) {
  std::map<std::array<Index, 3>, std::vector<Index>> sides;
  for (Index t = 0; t < mesh.tets.size(); ++t)
    for (unsigned corner = 0; corner < 4; ++corner) {
      auto side = side_corners(mesh.tets[t], corner);
      std::sort(side.begin(), side.end());
      sides[side].push_back(t);
    }
  return sides;
}

template <class Cells>
bool in_order_of_least_points(const Cells& cells) {
  return std::is_sorted(cells.begin(), cells.end(), [](const auto& a, const auto& b) {
    return *std::min_element(a.begin(), a.end()) < *std::min_element(b.begin(), b.end());
  });
}

TEST(Extraction, KnowsNeighboursAndTheComplexFindsTheRest) {
  for (const Shape& shape : shapes()) {
    SCOPED_TRACE(shape.name);
    const Plc plc = build_plc(shape.soups, {.feature_angle = 30});
    KnownNeighbours known;
    MeshOptions options = testing::with_size(shape.size);
    options.threads = 1;
    TetMesh mesh = generate(plc, options, {}, known).mesh;
    ASSERT_FALSE(mesh.tets.empty());
    for (const unsigned threads : {2U, 8U}) {
      options.threads = threads;
      KnownNeighbours again;
      EXPECT_EQ(generate(plc, options, {}, again).mesh.tets, mesh.tets);
      EXPECT_EQ(again, known);
    }
    ASSERT_EQ(known.size(), mesh.tets.size());
    const auto tets_of = sides(mesh);
    std::size_t open = 0, shared = 0;
    TetMesh copy = mesh;
    const remeshing::TetComplex with(mesh, known), without(copy);
    for (Index t = 0; t < mesh.tets.size(); ++t)
      for (unsigned corner = 0; corner < 4; ++corner) {
        auto side = side_corners(mesh.tets[t], corner);
        std::sort(side.begin(), side.end());
        const auto& tets = tets_of.at(side);
        ASSERT_LE(tets.size(), 2U);
        const Index beyond = tets.size() < 2 ? none : tets[0] == t ? tets[1] : tets[0];
        EXPECT_TRUE(known[t][corner] == none || known[t][corner] == beyond);
        shared += beyond != none ? 1 : 0;
        open += beyond != none && known[t][corner] == none ? 1 : 0;
        EXPECT_EQ(with[t].neighbours[corner], beyond);
        EXPECT_EQ(without[t].neighbours[corner], beyond);
        EXPECT_EQ(with[t].faces[corner], without[t].faces[corner]);
      }
    const auto stitched = std::count_if(mesh.tet_collar.begin(), mesh.tet_collar.end(),
                                        [](std::uint8_t collar) { return collar != 0; });
    EXPECT_LE(open, 8 * static_cast<std::size_t>(stitched));  // each stitched tet has 4 sides, each counted
                                                              // from both of its tets
    EXPECT_GT(shared, open);
  }
}

TEST(Extraction, KeepsWhatBelongsToATet) {
  for (const Shape& shape : shapes()) {
    SCOPED_TRACE(shape.name);
    const auto meshed = testing::mesh_of(shape.soups, testing::with_size(shape.size));
    EXPECT_EQ(testing::faults(meshed), "");  // regions, tags, patches and features
    const TetMesh& mesh = meshed.result.mesh;
    for (Index t = 0; t < mesh.tets.size(); ++t) {
      if (mesh.tet_collar[t] == 0) {
        EXPECT_EQ(mesh.tet_crease[t], 0);
        continue;
      }
      const bool at_crease = std::ranges::any_of(mesh.tets[t], [&](Index v) {
        const auto& [dimension, feature] = mesh.features[v];
        return (dimension == 0 && meshed.plc.vertices[feature].tag == mesh.tet_crease[t]) ||
               (dimension == 1 && meshed.plc.curves[feature].tag == mesh.tet_crease[t]);
      });
      EXPECT_TRUE(at_crease) << t;
    }
  }
}

TEST(Extraction, LaysInMemoryWhatIsNearTogether) {
  for (const Shape& shape : shapes()) {
    SCOPED_TRACE(shape.name);
    const TetMesh mesh = testing::mesh_of(shape.soups, testing::with_size(shape.size)).result.mesh;
    EXPECT_TRUE(in_order_of_least_points(mesh.tets));
    EXPECT_TRUE(in_order_of_least_points(mesh.faces));
  }
  const TetMesh mesh = testing::mesh_of(testing::box(), testing::with_size(0.06)).result.mesh;
  double spread = 0;
  for (const auto& tet : mesh.tets) {
    const auto [least, greatest] = std::minmax_element(tet.begin(), tet.end());
    spread += *greatest - *least;
  }
  // In a random order the spread would be 60% of all points.
  testing::expect_count("extraction/spread of corners",
                        100 * spread / static_cast<double>(mesh.tets.size() * mesh.points.size()));
}

}  // namespace
}  // namespace collarmesh::extraction_test
