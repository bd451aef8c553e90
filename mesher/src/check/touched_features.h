#pragma once

#include <string>
#include <vector>

#include "check/mesh_to_check.h"

namespace collarmesh::checks {

/// The features of the complex that the corners of tets lie on, for messages.
class TouchedFeatures {
 public:
  /// Precondition: to_check.match is filled in. Keeps a reference to `to_check`. Cost: linear.
  explicit TouchedFeatures(const MeshToCheck& to_check);

  /// Names the region of a tet and the features that the tet touches: "in region 1 (tag 1) and touching curve
  /// 3 (tag 4), patch 0 (tag 7, inlet)". Curves and patches that contain most corners come first.
  std::string of(Index tet) const;

 private:
  const MeshToCheck& to_check_;
  std::vector<TetMesh::VertexFeature> features_;
};

}  // namespace collarmesh::checks
