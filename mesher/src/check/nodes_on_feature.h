#pragma once

#include <string_view>

#include "check/mesh_to_check.h"
#include "check/predicates.h"
#include "common/distance_tree.h"

namespace collarmesh::checks {

/// A curve or patch of the complex, for checking that the mesh's nodes on it are within the allowed distance.
class NodesOnFeature {
 public:
  /// Keeps the mesh to check by reference.
  NodesOnFeature(const MeshToCheck& to_check, const TetMesh::VertexFeature& feature);

  /// Adds a finding if a node is farther from the feature than is allowed. For a bent curve or smooth patch,
  /// raises `largest` to at least the node's distance.
  void check(std::string_view guarantee, const Named& node, const Point& at, double& largest,
             Findings& findings) const;

 private:
  const MeshToCheck& to_check_;
  TetMesh::VertexFeature feature_;
  DistanceTree pieces_;  // triangles or segments; empty for a planar patch
};

}  // namespace collarmesh::checks
