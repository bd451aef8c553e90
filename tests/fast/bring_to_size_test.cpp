// Meshes with any shapes and lengths come close to their sizes, with any number of threads.
#include "adapt/bring_to_size.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "collarmesh/surface_tolerance.h"
#include "support/meshing.h"
#include "support/shapes.h"

namespace collarmesh::bring_to_size_test {
namespace {

using namespace testing;

/// A sphere with a mesh finer than it is to be, whose vertices inside are pushed aside.
Meshed pushed_sphere() {
  Meshed made = mesh_of(icosphere(1, 4), with_size(0.32));
  TetMesh& mesh = made.result.mesh;
  for (Index v = 0; v < mesh.points.size(); ++v)
    if (mesh.features[v].dimension == 3) {
      const double turn = static_cast<double>(v);
      mesh.points[v] = mesh.points[v] + 0.01 * Vector{std::cos(turn), std::sin(turn), std::cos(2 * turn)};
    }
  return made;
}

TEST(BringToSize, IsTheSameForAnyNumberOfThreads) {
  const Meshed made = pushed_sphere();
  MeshOptions options = with_size(0.7);
  options.bounds.tolerance = tolerance_of(made.plc, options.bounds, options.size);
  TetMesh alone = made.result.mesh;
  options.threads = 1;
  ASSERT_TRUE(remeshing::adapting::bring_to_size(alone, made.plc, options, {}));
  EXPECT_LT(2 * alone.tets.size(), made.result.mesh.tets.size());
  for (const unsigned threads : {2U, 5U}) {
    TetMesh mesh = made.result.mesh;
    options.threads = threads;
    ASSERT_TRUE(remeshing::adapting::bring_to_size(mesh, made.plc, options, {}));
    EXPECT_EQ(mesh.tets, alone.tets);
    EXPECT_EQ(mesh.points, alone.points);
  }
}

// Where a few tets stay poor with one seed, those of another one may be good.
TEST(BringToSize, DependsOnTheSeed) {
  const Meshed made = mesh_of(box(), with_size(0.8));
  MeshOptions options = with_size(0.2);
  options.bounds.tolerance = tolerance_of(made.plc, options.bounds, options.size);
  std::vector<TetMesh> meshes(2, made.result.mesh);
  for (unsigned seed = 0; seed < meshes.size(); ++seed) {
    options.seed = seed;
    ASSERT_TRUE(remeshing::adapting::bring_to_size(meshes[seed], made.plc, options, {}));
    EXPECT_GT(meshes[seed].tets.size(), 10 * made.result.mesh.tets.size());
  }
  EXPECT_NE(meshes[0].points, meshes[1].points);
}

}  // namespace
}  // namespace collarmesh::bring_to_size_test
