#include "remesh/tet_complex.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <utility>

#include "adapt/mesh_complex.h"
#include "collarmesh/check.h"
#include "collarmesh/error.h"
#include "support/meshes.h"

namespace collarmesh::tet_complex_test {
namespace {

using remeshing::TetComplex;

/// Four tets around the edge from point 0 to point 1.
TetMesh tets_around_an_edge() {
  TetMesh mesh;
  mesh.points = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}};
  mesh.features.resize(mesh.points.size());
  for (Index i = 0; i < 4; ++i) mesh.tets.push_back({0, 1, 2 + i, 2 + (i + 1) % 4});
  mesh.tet_region.resize(4, 1);
  mesh.tet_tag.resize(4, 1);
  mesh.tet_collar.resize(4, 0);
  return mesh;
}

TEST(TetComplex, FindsTheRingOfAnEdge) {
  TetMesh mesh = tets_around_an_edge();
  TetComplex::Ring ring;
  TetComplex(mesh).ring(2, 0, 1, ring);
  EXPECT_TRUE(ring.closed);
  EXPECT_EQ(ring.tets.size(), 4U);
  EXPECT_EQ(ring.link.size(), 4U);
}

// A tet whose corners are in the wrong order sends the walk around the edge back.
TEST(TetComplex, RefusesTetsThatFormNoRing) {
  for (Index turned = 0; turned < 4; ++turned) {
    TetMesh mesh = tets_around_an_edge();
    std::swap(mesh.tets[turned][2], mesh.tets[turned][3]);
    const TetComplex complex(mesh);
    TetComplex::Ring ring;
    EXPECT_THROW(complex.ring((turned + 1) % 4, 0, 1, ring), PlcError) << turned;
  }
}

// The complex of a mesh

using remeshing::adapting::complex_of;

TEST(MeshComplex, OfABoxIsTheBox) {
  const testing::MeshedComplex box = testing::meshed_two_boxes(2);
  const TetMesh given = testing::without_features(box.mesh);
  const auto [plc, mesh] = complex_of(given, {});
  EXPECT_EQ(plc.patches.size(), box.plc.patches.size());
  EXPECT_EQ(plc.regions.size(), 3U);
  for (Index r = 1; r < plc.regions.size(); ++r) EXPECT_NEAR(plc.regions[r].volume, 1, 1e-12);
  for (const Plc::Patch& patch : plc.patches) EXPECT_NE(patch.regions[0], 0U) << "the outside is in front";
  EXPECT_EQ(mesh.tets.size(), given.tets.size());
  EXPECT_TRUE(check(mesh, plc, {.bounds = {.radius_edge = 10}}).passed());
}

TEST(MeshComplex, LinesThatJoinNoCornersOfATetAreRefused) {
  TetMesh mesh = testing::without_features(testing::meshed_box(2).mesh);
  const auto corner = [&](const Point& p) {
    return static_cast<Index>(std::find(mesh.points.begin(), mesh.points.end(), p) - mesh.points.begin());
  };
  mesh.edges.push_back({corner({0, 0, 0}), corner({1, 1, 1})});
  mesh.edge_curve.push_back(none);
  mesh.edge_tag.push_back(99);
  try {
    complex_of(mesh, {});
    ADD_FAILURE();
  } catch (const PlcError& error) {
    EXPECT_NE(std::string(error.what()).find("is no edge of a tetrahedron"), std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace collarmesh::tet_complex_test
