#include "remesh/smooth_surfaces.h"

#include <gtest/gtest.h>

#include <utility>

#include "support/meshing.h"
#include "support/shapes.h"

namespace collarmesh::smooth_surfaces_test {
namespace {

using remeshing::SmoothSurfaces;

// If such faces fitted, a change might fold a surface over itself and make tets that overlap.
TEST(SmoothSurfaces, FacesOfTheOppositeOrientationDoNotFit) {
  const testing::Meshed meshed = testing::mesh_of(testing::icosphere(0.6, 8), testing::with_size(0.35), 30);
  const TetMesh& mesh = meshed.result.mesh;
  const SmoothSurfaces surfaces(meshed.plc, mesh, SurfaceTolerance(0.1));
  ASSERT_FALSE(mesh.faces.empty());
  for (Index face = 0; face < mesh.faces.size(); ++face) {
    SmoothSurfaces::Face created{{}, mesh.face_patch[face]};
    for (unsigned i = 0; i < 3; ++i) created.corners[i] = mesh.points[mesh.faces[face][i]];
    EXPECT_TRUE(surfaces.fit({&face, 1}, {&created, 1})) << face;
    std::swap(created.corners[0], created.corners[1]);
    EXPECT_FALSE(surfaces.fit({&face, 1}, {&created, 1})) << face;
  }
}

}  // namespace
}  // namespace collarmesh::smooth_surfaces_test
