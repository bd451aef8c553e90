#pragma once

#include <string_view>

#include "check/predicates.h"
#include "check/subject.h"
#include "common/distance_tree.h"

namespace collarmesh::checks {

/// A curve or patch of the complex, from which its nodes may be only so far away.
class NodesOnFeature {
 public:
  /// Keeps the subject by reference.
  NodesOnFeature(const Subject& subject, const TetMesh::VertexFeature& feature);

  /// Adds a finding if a node is farther away than is allowed. If the feature is smooth, raises `largest` to
  /// the distance.
  void check(std::string_view guarantee, const Named& node, const Point& at, double& largest,
             Findings& findings) const;

 private:
  const Subject& subject_;
  TetMesh::VertexFeature feature_;
  DistanceTree pieces_;  // triangles or segments; empty for a planar patch
};

}  // namespace collarmesh::checks
