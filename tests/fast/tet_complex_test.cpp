#include "remesh/tet_complex.h"

#include <gtest/gtest.h>

#include <utility>

#include "collarmesh/error.h"

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

}  // namespace
}  // namespace collarmesh::tet_complex_test
