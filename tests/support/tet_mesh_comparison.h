#pragma once

#include <gtest/gtest.h>

#include "collarmesh/tet_mesh.h"

namespace collarmesh::testing {

/// Expects that every array is equal to the last bit.
inline void expect_same(const TetMesh& a, const TetMesh& b) {
  EXPECT_EQ(a.points, b.points);
  EXPECT_EQ(a.tets, b.tets);
  EXPECT_EQ(a.tet_region, b.tet_region);
  EXPECT_EQ(a.tet_tag, b.tet_tag);
  EXPECT_EQ(a.tet_collar, b.tet_collar);
  EXPECT_EQ(a.tet_crease, b.tet_crease);
  EXPECT_EQ(a.tet_thin, b.tet_thin);
  EXPECT_EQ(a.tet_partition, b.tet_partition);
  EXPECT_EQ(a.faces, b.faces);
  EXPECT_EQ(a.face_regions, b.face_regions);
  EXPECT_EQ(a.face_patch, b.face_patch);
  EXPECT_EQ(a.face_tag, b.face_tag);
  EXPECT_EQ(a.edges, b.edges);
  EXPECT_EQ(a.edge_curve, b.edge_curve);
  EXPECT_EQ(a.edge_tag, b.edge_tag);
  EXPECT_EQ(a.tet_mid_nodes, b.tet_mid_nodes);
  EXPECT_EQ(a.face_mid_nodes, b.face_mid_nodes);
  EXPECT_EQ(a.edge_mid_nodes, b.edge_mid_nodes);
  ASSERT_EQ(a.features.size(), b.features.size());
  for (std::size_t i = 0; i < a.features.size(); ++i) {
    EXPECT_EQ(a.features[i].dimension, b.features[i].dimension) << "point " << i;
    EXPECT_EQ(a.features[i].feature, b.features[i].feature) << "point " << i;
  }
}

}  // namespace collarmesh::testing
