#pragma once

#include <gtest/gtest.h>

#include "collarmesh/tet_mesh.h"

namespace collarmesh::testing {

/// Expects that all arrays of the two meshes are equal to the last bit.
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
  EXPECT_EQ(a.layers.prisms, b.layers.prisms);
  EXPECT_EQ(a.layers.prism_region, b.layers.prism_region);
  EXPECT_EQ(a.layers.prism_tag, b.layers.prism_tag);
  EXPECT_EQ(a.layers.prism_layer, b.layers.prism_layer);
  EXPECT_EQ(a.layers.prism_mid_nodes, b.layers.prism_mid_nodes);
  EXPECT_EQ(a.layers.pyramids, b.layers.pyramids);
  EXPECT_EQ(a.layers.pyramid_region, b.layers.pyramid_region);
  EXPECT_EQ(a.layers.pyramid_tag, b.layers.pyramid_tag);
  EXPECT_EQ(a.layers.pyramid_layer, b.layers.pyramid_layer);
  EXPECT_EQ(a.layers.pyramid_mid_nodes, b.layers.pyramid_mid_nodes);
  EXPECT_EQ(a.layers.quads, b.layers.quads);
  EXPECT_EQ(a.layers.quad_regions, b.layers.quad_regions);
  EXPECT_EQ(a.layers.quad_patch, b.layers.quad_patch);
  EXPECT_EQ(a.layers.quad_tag, b.layers.quad_tag);
  EXPECT_EQ(a.layers.quad_mid_nodes, b.layers.quad_mid_nodes);
  EXPECT_EQ(a.layers.tet_layer, b.layers.tet_layer);
  ASSERT_EQ(a.features.size(), b.features.size());
  for (std::size_t i = 0; i < a.features.size(); ++i) {
    EXPECT_EQ(a.features[i].dimension, b.features[i].dimension) << "point " << i;
    EXPECT_EQ(a.features[i].feature, b.features[i].feature) << "point " << i;
  }
}

}  // namespace collarmesh::testing
