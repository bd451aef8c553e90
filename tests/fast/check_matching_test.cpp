// A mesh without feature indices, as files contain it, is matched to the complex by tags and position.
#include <gtest/gtest.h>

#include "check/mesh_to_check.h"
#include "support/meshes.h"

namespace collarmesh::check_matching_test {
namespace {

using namespace collarmesh::testing;

void expect_same_match(const MeshedComplex& m) {
  const auto expected = checks::match_features(m.mesh, m.plc, 1e-12);
  const auto found = checks::match_features(without_features(m.mesh), m.plc, 1e-12);
  EXPECT_EQ(found.face_patch, expected.face_patch);
  EXPECT_EQ(found.edge_curve, expected.edge_curve);
  EXPECT_EQ(found.vertex_point, expected.vertex_point);
}

void forget_tags(MeshedComplex& m) {
  for (auto& patch : m.plc.patches) patch.tag = 0;
  for (auto& curve : m.plc.curves) curve.tag = 0;
  m.mesh.face_tag.assign(m.mesh.faces.size(), 0);
  m.mesh.edge_tag.assign(m.mesh.edges.size(), 0);
}

TEST(CheckMatching, ByTag) {
  expect_same_match(meshed_box(3));
  expect_same_match(meshed_two_boxes(2));
  expect_same_match(meshed_box_with_facet(4));
}

TEST(CheckMatching, ByPositionAlone) {
  for (MeshedComplex m :
       {meshed_box(3), meshed_two_boxes(2), meshed_box_with_facet(4), meshed_cylinder(12, 3)}) {
    forget_tags(m);
    expect_same_match(m);
  }
}

TEST(CheckMatching, RegionInPlaceOfItsTag) {
  const MeshedComplex m = meshed_two_boxes(2);
  TetMesh mesh = without_features(m.mesh);
  mesh.tet_tag.assign(mesh.tet_region.begin(), mesh.tet_region.end());
  EXPECT_TRUE(check(mesh, m.plc).passed());
  mesh.tet_tag[0] = 5;
  EXPECT_EQ(check(mesh, m.plc).findings_total, 1U);
}

TEST(CheckMatching, UnknownTagsMatchNothing) {
  MeshedComplex m = meshed_box(2);
  TetMesh mesh = without_features(m.mesh);
  mesh.face_tag[3] = 99;
  mesh.edge_tag[4] = 99;
  const auto match = checks::match_features(mesh, m.plc, 1e-12);
  EXPECT_EQ(match.face_patch[3], none);
  EXPECT_EQ(match.edge_curve[4], none);
}

}  // namespace
}  // namespace collarmesh::check_matching_test
